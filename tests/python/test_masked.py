# SPDX-License-Identifier: Apache-2.0
"""Arrays with a mask are refused wherever arrays are taken: what is masked is not meant to be used."""

import ast
import runpy

import numpy as np
import pytest

import penumbra
from conftest import ROOT

IMAGE = np.ones((480, 640), np.uint16)
METRES = np.ones((480, 640), np.float32)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2]], np.uint32)
POSE = np.eye(4)
POINT = np.array([1.0, 2.0, 3.0])
PIXEL = np.array([4.0, 5.0])
OUTLINE = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]])
VISIBLE = penumbra.Verdict.visible

# By class, method and argument: what is right, and a call of it; `o` has a recording's parts.
CASES = {
    "Intrinsics.project.point": (POINT, lambda o, x: o.camera.intrinsics.project(x)),
    "Camera.from_matrix.K": (
        np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]]),
        lambda o, x: penumbra.Camera.from_matrix(x, (640, 480))),
    "Distortion.distort.undistorted": (PIXEL, lambda o, x: o.camera.distortion.distort(x)),
    "Distortion.undistort.distorted": (PIXEL, lambda o, x: o.camera.distortion.undistort(x)),
    "DepthRegistration.warp.depth": (
        IMAGE, lambda o, x: penumbra.DepthRegistration(o.camera, o.camera).warp(x, POSE)),
    "DepthRegistration.warp.T_to_from": (
        POSE, lambda o, x: penumbra.DepthRegistration(o.camera, o.camera).warp(IMAGE, x)),
    "TriangleMesh.__init__.vertices": (CORNERS, lambda o, x: penumbra.TriangleMesh(x, FACES)),
    "TriangleMesh.__init__.triangles": (FACES, lambda o, x: penumbra.TriangleMesh(CORNERS, x)),
    "Robot.forward_kinematics.positions": (
        np.zeros(7), lambda o, x: o.robot.forward_kinematics(x)),
    "JointBuffer.insert.positions": (
        np.zeros(7), lambda o, x: penumbra.JointBuffer(o.robot).insert(0, o.robot.variables, x)),
    "Renderer.render.T_camera_body": (
        np.stack([POSE] * 11), lambda o, x: renderer_of(o).render(x)),
    "Renderer.submit.T_camera_body": (
        np.stack([POSE] * 11), lambda o, x: renderer_of(o).submit(x)),
    "Classifier.classify.virtual_depth": (METRES, lambda o, x: classifier().classify(x, IMAGE)),
    "Classifier.classify.measured": (IMAGE, lambda o, x: classifier().classify(METRES, x)),
    "PoseTrackerConfig.__init__.direction": (
        POINT, lambda o, x: penumbra.PoseTrackerConfig(direction=x)),
    "PoseTracker.update.pose": (POSE, lambda o, x: penumbra.PoseTracker().update(0, x, VISIBLE)),
    "PoseTracker.update.covariance": (
        np.eye(6), lambda o, x: penumbra.PoseTracker().update(0, POSE, VISIBLE, covariance=x)),
    "PointTracker.update.position": (
        POINT, lambda o, x: penumbra.PointTracker().update(0, x, VISIBLE)),
    "PointTracker.update.covariance": (
        np.eye(3), lambda o, x: penumbra.PointTracker().update(0, POINT, VISIBLE, covariance=x)),
    "PixelPolygon.__init__.corners": (OUTLINE, lambda o, x: penumbra.PixelPolygon(x)),
    "PixelEllipse.__init__.centre": (PIXEL, lambda o, x: penumbra.PixelEllipse(centre=x)),
    "PixelEllipse.__init__.semi_axes": (PIXEL, lambda o, x: penumbra.PixelEllipse(semi_axes=x)),
    "PixelMask.__init__.mask": (np.eye(4, dtype=bool), lambda o, x: penumbra.PixelMask(x)),
    "RenderedRegion.__init__.depth": (METRES, lambda o, x: penumbra.RenderedRegion(x)),
    "KeypointTarget.__init__.pixel": (PIXEL, lambda o, x: penumbra.KeypointTarget(pixel=x)),
    "KeypointTarget.__init__.semi_axes": (
        PIXEL, lambda o, x: penumbra.KeypointTarget(semi_axes=x)),
    "PointTarget.__init__.position": (POINT, lambda o, x: penumbra.PointTarget(x)),
    "BoxTarget.__init__.pose": (POSE, lambda o, x: penumbra.BoxTarget(x, POINT)),
    "BoxTarget.__init__.size": (POINT, lambda o, x: penumbra.BoxTarget(POSE, x)),
    "MeshTarget.__init__.pose": (
        POSE, lambda o, x: penumbra.MeshTarget(penumbra.TriangleMesh(CORNERS, FACES), x)),
    "TargetEstimate.__init__.value": (POSE, lambda o, x: penumbra.TargetEstimate(x)),
    "TargetEstimate.__init__.covariance": (
        np.eye(6), lambda o, x: penumbra.TargetEstimate(POSE, covariance=x)),
    "Frame.__init__.depth": (IMAGE, lambda o, x: penumbra.Frame(x, None)),
    "Frame.__init__.joints": (np.zeros(7), lambda o, x: penumbra.Frame(IMAGE, x)),
    "Frame.__init__.T_root_link": (
        np.stack([POSE] * 11), lambda o, x: penumbra.Frame(IMAGE, None, T_root_link=x)),
    "Frame.__init__.T_parent_camera": (
        POSE, lambda o, x: penumbra.Frame(IMAGE, None, T_parent_camera=x)),
    "PipelineConfig.__init__.T_parent_camera": (
        POSE, lambda o, x: penumbra.PipelineConfig(T_parent_camera=x)),
}


def renderer_of(opened):
    return penumbra.Renderer(penumbra.Backend.cpu, opened.camera.intrinsics, opened.robot.bodies)


def classifier():
    return penumbra.Classifier(640, 480, penumbra.LabelRule())


def test_every_argument_that_is_an_array_is_among_the_cases():
    maker = runpy.run_path(str(ROOT / "scripts" / "python_stubs.py"))
    found = set()
    for of in ast.walk(ast.parse(maker["stubs"](penumbra._core))):
        # What replace() is given goes into the constructor.
        for method in [m for m in getattr(of, "body", ()) if isinstance(m, ast.FunctionDef)]:
            for a in method.args.args + method.args.kwonlyargs:
                taken = ast.unparse(a.annotation) if a.annotation else ""
                if ("ArrayLike" in taken or "NDArray" in taken) and method.name != "replace":
                    found.add(f"{getattr(of, 'name', '')}.{method.name}.{a.arg}")
    assert found == set(CASES)


@pytest.mark.parametrize("name", CASES)
def test_masked_arrays_are_refused(shipped, name):
    right, call = CASES[name]
    call(shipped, right)
    one = np.zeros(right.shape, bool)
    one.flat[0] = True
    for mask in (one, np.ma.nomask):
        with pytest.raises(TypeError) as raised:
            call(shipped, np.ma.masked_array(right, mask=mask))
        assert "its mask would be lost" in str(raised.value)
        assert "expected" in str(raised.value) and "got numpy.ndarray" in str(raised.value)


@pytest.mark.parametrize("name", CASES)
def test_masks_within_lists_are_refused(shipped, name):
    right, call = CASES[name]
    masked = np.ma.masked_array(right, mask=right == right)
    for parts in (list(masked), tuple(right[:-1]) + (masked[-1],)):
        with pytest.raises(TypeError) as raised:
            call(shipped, parts)
        is_image = "got list" in str(raised.value) or "got tuple" in str(raised.value)
        assert is_image or "its mask would be lost" in str(raised.value)


def test_a_masked_position_is_refused_as_an_estimate():
    with pytest.raises(TypeError, match="its mask would be lost"):
        penumbra.TargetEstimate(np.ma.masked_array(POINT, mask=[1, 0, 0]))


def test_changes_of_a_frame_are_looked_at_likewise(shipped):
    with pytest.raises(TypeError, match="its mask would be lost"):
        shipped.frames[0].frame.replace(joints=np.ma.masked_array(np.zeros(7), mask=np.eye(7)[0]))


@pytest.mark.filterwarnings("ignore:.*converting a masked element to nan")
@pytest.mark.parametrize("call", [
    lambda x: penumbra.Distortion("plumb_bob", x * 1.0), lambda x: penumbra.RunLengthMask(2, 2, x),
    lambda x: penumbra.Frame(IMAGE, None, doubted_links=x)])
def test_masked_numbers_of_lists_are_refused(call):
    right = np.array([0, 1, 2, 1])
    call(right)
    with pytest.raises((TypeError, ValueError)):
        call(np.ma.masked_array(right, mask=[0, 0, 1, 0]))


def test_other_arrays_are_taken(shipped):
    class Own(np.ndarray):
        """Of a class of its own, without a mask."""

    for joints in (np.zeros(7).view(Own), [np.float32(0)] * 7, (0,) * 7, np.zeros(7, np.int32)):
        assert np.array_equal(penumbra.Frame(IMAGE, joints).joints, np.zeros(7))
    poses = [POSE, POSE.astype(np.float32).tolist()]
    assert np.array_equal(penumbra.Frame(IMAGE, None, T_root_link=poses).T_root_link, [POSE, POSE])
