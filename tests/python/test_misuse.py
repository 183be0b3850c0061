# SPDX-License-Identifier: Apache-2.0
"""Whatever is given wrongly is a TypeError or ValueError that says what is expected."""

import enum
import pickle
import re

import numpy as np
import pytest

import penumbra
from conftest import refuses, ROOT, SHIPPED

GOOD = np.zeros((480, 640), np.uint16)
POSE = np.eye(4)

BAD_DEPTHS = [
    (None, TypeError, "uint16 or float32"),
    ([[1, 2], [3, 4]], TypeError, "got list"),
    ("depth", TypeError, "got str"),
    (GOOD.astype(np.int32), TypeError, "got numpy.ndarray of int32"),
    (GOOD.astype(np.float64), TypeError, ".astype(np.float32)"),
    (GOOD.ravel(), ValueError, "shape (H, W)"),
    (GOOD[:0], ValueError, "shape (H, W)"),
    (np.zeros((480, 1280), np.uint16)[:, ::2], ValueError, "side by side"),
    (np.asfortranarray(np.ones((480, 640), np.uint16)), ValueError, "side by side"),
    (np.ndarray((480, 640), np.uint16, bytes(2 * 640 * 480 + 1), 1), ValueError, "not aligned"),
    (np.ma.masked_array(GOOD, mask=GOOD == 0), TypeError, "its mask would be lost"),
    (GOOD[:10], ValueError, "(480, 640)"),
    (GOOD[:, :10], ValueError, "(480, 640)"),
]


@pytest.mark.parametrize("depth, error, says", BAD_DEPTHS)
def test_classifiers_and_frames_refuse_images(depth, error, says):
    classifier = penumbra.Classifier(640, 480, penumbra.LabelRule())
    calls = {"measured": lambda: classifier.classify(np.zeros((480, 640), np.float32), depth)}
    if depth is not None and says != "(480, 640)":
        calls["depth"] = lambda: penumbra.Frame(depth, None)
    for name, call in calls.items():
        refuses(f"{name}: expected.*{re.escape(says)}|{re.escape(says)}.*{name}: expected", call, error)


def test_other_arrays_are_taken():
    class Own(np.ndarray):
        """A subclass without a mask."""

    for joints in (np.zeros(7).view(Own), [np.float32(0)] * 7, (0,) * 7, np.zeros(7, np.int32)):
        assert np.array_equal(penumbra.Frame(GOOD, joints).pose.positions, np.zeros(7))
    poses = [POSE, POSE.astype(np.float32).tolist()]
    assert np.array_equal(penumbra.RobotPose(T_root_link=poses).T_root_link, [POSE, POSE])


def test_enumerations_have_all_values_of_the_headers_and_errors_their_classes():
    found = {}
    for folder in ("penumbra", "io", "sim"):
        for header in (ROOT / folder).rglob("*.hpp"):
            for name, body in re.findall(r"enum class (\w+)[^{;]*\{([^}]*)\}", header.read_text()):
                body = re.sub(r"//.*", "", body)
                found.setdefault(name, []).append(
                    {value.split("=")[0].strip() for value in body.split(",") if value.strip()})
    compared = 0
    for name, kind in vars(penumbra).items():
        if isinstance(kind, enum.EnumMeta) or hasattr(kind, "__members__"):
            values = {"none" if value == "none_" else value for value in kind.__members__}
            assert values in found.get(name, [values]), name
            compared += name in found
    assert compared > 10
    assert issubclass(penumbra.InputError, ValueError) and issubclass(penumbra.DeviceError, RuntimeError)


def test_rows_may_lie_apart_and_run_upwards(opened):
    frame = opened.frames[4]
    expected = opened.session.process(frame).labels.copy()
    apart = np.zeros((480, 700), np.uint16)
    apart[:, 30:670] = frame.depth
    upwards = np.ascontiguousarray(frame.depth[::-1])[::-1]
    for same in (apart[:, 30:670], upwards):
        assert np.array_equal(opened.session.process(frame.replace(depth=same)).labels, expected)


def test_images_of_another_size_raise(opened):
    for wrong, says in ((GOOD[:10].copy(), ""), (GOOD[:, :10].copy(), ""),
                        (np.zeros((640, 480), np.float32), "transposed")):
        with pytest.raises(ValueError, match=says) as raised:
            opened.session.process(opened.frames[0].replace(depth=wrong))
        assert "(480, 640)" in str(raised.value) and str(wrong.shape) in str(raised.value)
    assert opened.session.process(opened.frames[0]).status is penumbra.FrameStatus.ok


def classified(bad):
    virtual_depth = np.zeros((480, 640), np.float32)
    virtual_depth[3, 639] = bad
    return penumbra.Classifier(640, 480, penumbra.LabelRule()).classify(virtual_depth, GOOD)


BAD_CALLS = [
    (lambda o: o.session.process(None), TypeError, "penumbra.Frame"),
    (lambda o: o.session.process(o.frames[0].replace(pose=[0, 0])), ValueError, "expected 7 positions"),
    (lambda o: o.session.process(penumbra.Frame(None, o.frames[0].pose.replace(uncertain_links=[11]))),
     penumbra.InputError, "below 11"),
    (lambda o: penumbra.Session(None, o.camera), TypeError, "penumbra.Robot"),
    (lambda o: penumbra.PipelineConfig(backend="gl"), TypeError, "penumbra.Backend"),
    (lambda o: penumbra.PipelineConfig(bakend=None), TypeError, "backend"),
    (lambda o: penumbra.LabelRule(front_min_width=None), TypeError, "front_min_width: int"),
    (lambda o: penumbra.Classifier(0, 480, penumbra.LabelRule.paper()), ValueError, "1 to 32767"),
    (lambda o: penumbra.Intrinsics(0, 0, 1, 1, 0, 0), ValueError, "1 .. 32767"),
    (lambda o: o.camera.intrinsics.project([0, 0, -1]), penumbra.InputError, "z must be above 0"),
    (lambda o: classified(np.float32(np.nan)), penumbra.InputError, "row 3 has negative values"),
    (lambda o: classified(-1), penumbra.InputError, "row 3 has negative values"),
    (lambda o: penumbra.DepthRegistration(o.camera, o.camera).warp(GOOD, np.diag([2.0, 2, 2, 1])),
     ValueError, "T_to_from: expected a finite rotation"),
    (lambda o: penumbra.KeypointTarget(), TypeError, "pixel"),
    (lambda o: penumbra.PixelEllipse(), TypeError, "centre"),
    (lambda o: penumbra.JointBuffer(o.robot).insert(0, ["elbow"], [0.0, 1.0]), penumbra.InputError,
     "2 positions for 1 names"),
    (lambda o: penumbra.robot_mask(o.robot, o.camera, np.degrees(o.frames[0].pose.positions)),
     penumbra.InputError, "far beyond its limits"),
    (lambda o: o.session.process(o.frames[0]).point_views("forearm", [[0, 0, np.nan]]),
     penumbra.InputError, "point 0 is not finite"),
    (lambda o: o.session.process(GOOD, np.zeros(7), stamp=1.7e9), TypeError, "integer nanoseconds"),
    (lambda o: o.frames[0].replace(stamp=np.float32(1)), TypeError, "integer nanoseconds"),
    (lambda o: penumbra.Target("a", None, stamp=1.7e9), TypeError, "integer nanoseconds"),
    (lambda o: penumbra.TargetEstimate(None, stamp=1.7e9), TypeError, "integer nanoseconds"),
    (lambda o: penumbra.JointBuffer(o.robot).at(1.7e9), TypeError, "integer nanoseconds"),
    (lambda o: penumbra.calibrate(3 * [GOOD], o.camera, o.robot), TypeError,
     "frames[0]: expected penumbra.Frame; got numpy.ndarray of uint16"),
    (lambda o: penumbra.RunLengthMask(640, 480, "o"), penumbra.InputError, "damaged run lengths"),
    (lambda o: penumbra.Robot.load(SHIPPED / "nothing.urdf"), ValueError, "nothing.urdf"),
    (lambda o: penumbra.Robot.load(SHIPPED, {"packages": {}}), TypeError, "penumbra.RobotOptions"),
    (lambda o: o.robot.forward_kinematics([0.0]), ValueError, "(7,)"),
    (lambda o: o.robot.forward_kinematics([float("nan")] * 7), ValueError, "+-1e9"),
    (lambda o: o.robot.meshes(99), IndexError, "below 11"),
    (lambda o: o.robot.find_variable("tail"), KeyError, "tail"),
    (lambda o: o.frames[12], IndexError, "frame 12"),
    (lambda o: penumbra.Frame(GOOD, 1.0), ValueError, "shape (N,)"),
    (lambda o: penumbra.Frame(GOOD, {"elbow": 0}), TypeError, "penumbra.RobotPose"),
    (lambda o: penumbra.Frame(GOOD, None, color=GOOD), TypeError, "(H, W, 3)"),
    (lambda o: penumbra.Frame(GOOD, None, targets=[None]), TypeError, "penumbra.Target"),
    (lambda o: penumbra.RobotPose(T_parent_camera=np.ones((4, 4))), ValueError, "0 0 0 1"),
    (lambda o: penumbra.TriangleMesh(np.zeros((3, 3)), np.zeros((1, 3), np.uint32)), TypeError,
     "float32"),
    (lambda o: penumbra.TriangleMesh(np.zeros((3, 3), np.float32), np.full((1, 3), 3, np.uint32)),
     ValueError, "below the number of vertices, 3"),
    (lambda o: penumbra.PixelMask(np.zeros((4, 4))), TypeError, "bool or uint8"),
    (lambda o: penumbra.PixelPolygon([1, 2, 3]), ValueError, "(N, 2)"),
    (lambda o: penumbra.Target("", None).check(), ValueError, "name"),
    (lambda o: penumbra.TargetEstimate(np.eye(3)), ValueError, "(3,)"),
    (lambda o: penumbra.PoseTracker(penumbra.PoseTrackerConfig(timeout=-1)), ValueError, "timeout"),
    (lambda o: penumbra.PoseTracker().update(1, np.eye(4), "visible"), TypeError,
     "penumbra.Verdict"),
    (lambda o: penumbra.open("nowhere"), penumbra.InputError, "nowhere"),
    (lambda o: penumbra.open(SHIPPED, bag=penumbra.BagOptions()), ValueError, "bags"),
    (lambda o: penumbra.open(SHIPPED, frames=(3, 99)), ValueError, "0 to 11"),
    (lambda o: pickle.dumps(o.session), TypeError, "pickle"),
    (lambda o: setattr(o.config, "backend", None), AttributeError, "no setter"),
]


@pytest.mark.parametrize("call, error, says", BAD_CALLS)
def test_wrong_calls_say_what_is_expected(shipped, call, error, says):
    refuses(re.escape(says), lambda: call(shipped), error)


def test_renderers_refuse_poses(opened):
    renderer = penumbra.Renderer(penumbra.Backend.cpu, opened.camera.intrinsics, opened.robot.bodies)
    good = opened.robot.forward_kinematics(opened.robot.rest_positions())
    for poses, says in ((good[:3], "(11, 4, 4)"), (np.full((11, 4, 4), np.nan), "0 0 0 1"),
                        (good * np.array([2, 2, 2, 1])[:, None], "rotations"), (good[0], "(N, 4, 4)")):
        refuses(r".*" + says.replace("(", r"\(").replace(")", r"\)"), lambda: renderer.render(poses), ValueError)
    renderer.submit(good)
    assert renderer.pending == renderer.max_pending == 1
    refuses("pending", lambda: renderer.submit(good), ValueError)
    refuses("pending", lambda: renderer.render(good), ValueError)
    assert renderer.collect().depth.shape == (480, 640)
    refuses("no frame is pending", lambda: renderer.collect(), ValueError)


def test_an_inverted_camera_pose_is_diagnosed(opened):
    pose = opened.camera.T_parent_camera
    for cause, T_parent_camera in (("none", pose), ("camera_inverted", np.linalg.inv(pose))):
        camera = opened.camera.replace(T_parent_camera=T_parent_camera)
        session = penumbra.Session(opened.robot, camera, opened.config)
        for frame in opened.frames:
            session.process(frame)
        assert session.diagnosis().cause == cause, session.diagnosis().message
