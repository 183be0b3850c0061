# SPDX-License-Identifier: Apache-2.0
"""Each stage alone, against the others and against numbers by hand."""

import numpy as np
import pytest

import penumbra
from conftest import refuses, SHIPPED


def box_mesh(size):
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return penumbra.TriangleMesh((size / 2 * corners).astype(np.float32), np.array(faces, np.uint32))


def pose(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


INTRINSICS = penumbra.Intrinsics(64, 48, 50.0, 50.0, 31.5, 23.5)


@pytest.mark.parametrize("backend", [penumbra.Backend.cpu, penumbra.Backend.reference])
def test_a_box_is_drawn_where_the_formula_has_it(backend):
    renderer = penumbra.Renderer(backend, INTRINSICS, [penumbra.Body("box", [box_mesh(0.5)])])
    assert renderer.triangle_count == 12 and renderer.info.backend is backend
    shown = renderer.render([pose(0, 0, 2)])
    depth, links = shown.depth, shown.links
    assert depth.dtype == np.float32 and depth.shape == (48, 64)
    assert links.dtype == np.uint16
    # The front face is a square of side 0.5 at 1.75 m: 50 * 0.5 / 1.75 = 14.3 pixels.
    assert np.count_nonzero(depth) == 14 * 14
    assert np.allclose(depth[depth > 0], 1.75, atol=1e-5)
    assert np.array_equal(links, (depth > 0).astype(np.uint16))


def test_labels_follow_the_rule():
    rule = penumbra.LabelRule(tolerance=penumbra.Tolerance(a=0.1, b=0, c=0), front_min_width=0)
    classifier = penumbra.Classifier(5, 1, rule)
    virtual = np.full((1, 5), 2.0, np.float32)
    virtual[0, 4] = 0
    measured = np.array([[1.5, 1.95, 2.5, 0.0, 1.0]], np.float32)
    labels = classifier.classify(virtual, measured)
    L = penumbra.Label
    assert labels.labels.tolist() == [[L.front, L.occluded, L.beyond, L.unknown, L.clear]]
    assert labels.pixels[L.front] == 1
    assert sum(labels.pixels.values()) == 5


def test_another_robot_is_painted_before_what_is_behind_it():
    virtual_depth = np.array([[1.0, 1.0, 1.0, 1.0, 0.0]], np.float32)
    measured = np.array([[1.2, 0.985, 0.9, 0.0, 0.5]], np.float32)
    tolerance = penumbra.Tolerance(a=0.02, b=0.0, c=0.0)
    front = penumbra.front_of(virtual_depth, measured, tolerance)
    assert front.tolist() == [[255, 255, 0, 255, 0]]
    millimetres = (1000 * measured).astype(np.uint16)
    assert np.array_equal(penumbra.front_of(virtual_depth, millimetres, tolerance), front)
    refuses("5x1", lambda: penumbra.front_of(virtual_depth, measured[:, :3]))


def test_the_stages_alone_make_what_the_pipeline_makes(opened):
    frame = opened.frames[5]
    report = opened.session.process(frame)
    T_root_link = opened.robot.forward_kinematics(frame.pose.positions)
    assert np.array_equal(T_root_link, report.T_root_link)
    assert np.allclose(report.T_root_camera, opened.camera.T_parent_camera)

    renderer = penumbra.Renderer(penumbra.Backend.cpu, opened.camera.intrinsics, opened.robot.bodies)
    shown = renderer.render(np.linalg.inv(report.T_root_camera) @ T_root_link)
    # Inverted in another way, so that last digits of the poses differ.
    assert np.count_nonzero(shown.links != report.link_image) <= 2
    same = shown.links == report.link_image
    assert np.allclose(shown.depth[same], report.virtual_depth[same], atol=1e-5)

    size = opened.camera.intrinsics.width, opened.camera.intrinsics.height
    labels = penumbra.Classifier(*size, opened.session.rule).classify(shown, frame.depth).labels
    assert np.count_nonzero(labels != report.labels) <= 4


@pytest.mark.parametrize("image", list(penumbra.ImageSpace))
def test_the_mask_of_the_robot_is_where_virtual_depth_is(opened, image):
    lens = penumbra.Distortion("plumb_bob", [0.1, -0.05, 0.001, 0.002, 0.0])
    camera = opened.camera.replace(distortion=lens)
    session = penumbra.Session(opened.robot, camera, opened.config.replace(image=image))
    report = session.process(opened.frames[5])
    mask = report.robot_mask
    assert mask.dtype == bool and mask.shape == report.labels.shape and not mask.flags.writeable
    assert np.array_equal(mask, report.virtual_depth > 0) and np.array_equal(mask, report.link_image > 0)
    assert np.count_nonzero(mask) == report.pixels.robot > 10_000
    unread = session.process(opened.frames[6])
    session.process(opened.frames[7])
    assert report.robot_mask is mask
    refuses("before", lambda: unread.robot_mask, ValueError)


def test_the_camera_maps_points_and_lenses(tmp_path):
    k = penumbra.Intrinsics(640, 480, 600, 610, 320, 240)
    assert np.allclose(k.project(k.ray(12, 34) * 1.5), [12, 34])
    assert k.binned(2, 2) == penumbra.Intrinsics(320, 240, 300, 305, 159.75, 119.75)
    lens = penumbra.Distortion("plumb_bob", [0.1, -0.05, 0.001, 0.002, 0.0])
    assert lens.model is penumbra.DistortionModel.plumb_bob
    assert lens.coefficients.tolist() == [0.1, -0.05, 0.001, 0.002, 0.0]
    assert np.allclose(lens.undistort(lens.distort([0.2, -0.1])), [0.2, -0.1], atol=1e-9)
    camera = penumbra.Camera(k, distortion=lens, range=penumbra.DepthRange(near=0.3))
    both = penumbra.Rectification(camera)
    assert both.raw_to_pinhole.shape == (480, 640)
    centre = both.raw_to_pinhole[240, 320]
    assert both.pinhole_to_raw.reshape(-1)[centre] == 240 * 640 + 320
    read = penumbra.read_camera_info(SHIPPED / "camera_info.yaml", rectified=False)
    assert read.intrinsics == penumbra.Intrinsics(640, 480, 611.42, 611.17, 326.38, 235.71)


def test_depth_is_brought_to_another_camera():
    k = penumbra.Intrinsics(32, 24, 30, 30, 15.5, 11.5)
    registration = penumbra.DepthRegistration(penumbra.Camera(k), penumbra.Camera(k))
    wall = np.full((24, 32), 1500, np.uint16)
    assert np.array_equal(registration.warp(wall, np.eye(4)), wall)
    nearer = registration.warp(wall, pose(0, 0, -0.5)).copy()
    assert nearer.dtype == np.uint16 and set(np.unique(nearer)) == {1000}


def test_a_joint_buffer_never_extrapolates(shipped):
    buffer = penumbra.JointBuffer(shipped.robot, penumbra.JointBufferOptions(max_gap=0.05))
    rest = shipped.robot.rest_positions()
    names = shipped.robot.variables
    assert buffer.insert(1_000_000_000, names, rest) == len(names)
    assert buffer.insert(1_040_000_000, names, rest + 0.016) == len(names)
    answer = buffer.at(1_010_000_000)
    assert answer.status is penumbra.JointStatus.ok and answer.age == 30_000_000
    assert np.allclose(answer.positions, rest + 0.004)
    stale = buffer.at(1_100_000_000)
    assert stale.status is penumbra.JointStatus.stale
    assert stale.gaps[0].last_seen == 1_040_000_000
    report = shipped.session.process(penumbra.Frame(shipped.frames[0].depth, penumbra.pose_of(shipped.robot, stale)))
    assert report.status is penumbra.FrameStatus.stale_joints
    assert report.virtual_depth is None and report.robot_mask is None
    assert set(np.unique(report.labels)) == {penumbra.Label.unknown}


def test_robots_tell_of_their_parts(shipped):
    robot = shipped.robot
    assert robot.links[0] == "base_link" and robot.joints[0].child == 1
    assert robot.find_link("gripper") == robot.links.index("gripper")
    assert robot.find_link("nothing") is None
    meshes = robot.meshes(robot.find_link("forearm"))
    report = robot.report[robot.find_link("forearm")]
    assert sum(len(mesh.triangles) for mesh in meshes) == report.triangles > 0
    assert meshes[0].vertices.dtype == np.float32 and not meshes[0].vertices.flags.writeable
    parsed = penumbra.Robot.parse("<robot name='r'><link name='l'/></robot>", "")
    assert parsed.links == ("l",) and parsed.variables == ()


def test_two_publishers_of_one_joint_are_compared(shipped):
    robot = shipped.robot
    buffer = penumbra.JointBuffer(robot)
    names, zeros = list(robot.variables), [0.0] * len(robot.variables)
    for i in range(100):
        buffer.insert(10_000_000 * i, names, zeros, source="driver")
        buffer.insert(10_000_000 * i + 5, names, [0.5, *zeros[1:]], source="sliders")
    answer = buffer.at(500_000_000)
    assert answer.status is penumbra.JointStatus.disputed
    (dispute,) = answer.disputes
    assert dispute.variable == 0 and list(dispute.sources) == ["driver", "sliders"]
    assert list(dispute.values) == [0.0, 0.5] and "disputed" in repr(answer)
    frame = shipped.frames[0].replace(pose=penumbra.pose_of(robot, answer))
    report = shipped.session.process(frame)
    assert report.status is penumbra.FrameStatus.poses_disagree
    assert "sliders" in report.message


def test_points_without_the_robot(shipped):
    frame = shipped.frames[4]
    report = shipped.session.process(frame)
    trusted = np.isin(report.labels, [penumbra.Label.clear, penumbra.Label.front])
    filtered = report.without_robot()
    assert np.array_equal(filtered, np.where(trusted, frame.depth, 0))
    color = np.arange(filtered.size * 3, dtype=np.uint32).astype(np.uint8).reshape(*filtered.shape, 3)
    cloud = report.points(color=color)
    v, u = np.nonzero(filtered)
    assert np.array_equal(cloud.pixels, v * filtered.shape[1] + u)
    assert np.array_equal(cloud.colors, color[v, u])
    k = shipped.session.intrinsics
    z = filtered[v, u] * 0.001
    expected = np.stack([(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z], axis=1)
    assert np.allclose(cloud.points, expected, atol=1e-5)
    root = report.points(frame=report.links[0])
    T = report.T_root_camera
    assert np.allclose(root.points, expected @ T[:3, :3].T + T[:3, 3], atol=1e-5)
    assert len(root) == len(cloud) and root.colors.shape == (0, 3)
    refuses("no link 'hand'", lambda: report.points(frame="hand"))
    refuses("color", lambda: report.points(color=color[:-1]), ValueError)
    shipped.session.process(frame)
    refuses("another frame", lambda: report.without_robot(), ValueError)


def test_points_of_a_link_are_where_the_camera_sees_them(opened):
    robot, k = opened.robot, opened.camera.intrinsics
    points = robot.points_on("forearm", 500)
    assert points.shape == (500, 3) and np.array_equal(points, robot.points_on("forearm", 500))
    reports = []
    for frame, _ in zip(opened.frames, range(3)):
        reports.append(report := opened.session.process(frame))
        views = report.point_views("forearm", points)
        T = np.linalg.inv(report.T_root_camera) @ report.T_root_link[robot.links.index("forearm")]
        x, y, z = T[:3, :3] @ points.T + T[:3, 3:]
        assert np.allclose(views.depths, z) and views.pixels.shape == (500, 2)
        assert np.allclose(views.pixels, np.stack([x / z * k.fx + k.cx, y / z * k.fy + k.cy], axis=1))
        verdicts = np.array([of.value for of in penumbra.Verdict])[views.verdicts]
        assert np.array_equal(views.visible, verdicts == "visible")
        assert 100 < views.visible.sum() < 300  # half of it faces away
        u, v = np.rint(views.pixels[views.visible]).astype(int).T
        assert np.all(report.labels[v, u] == penumbra.Label.occluded)
        assert np.all((views.hidden_by > 0) <= (verdicts == "hidden"))
    refuses("no link 'fourarm'", lambda: report.point_views("fourarm", points))
    refuses("3", lambda: report.point_views("forearm", points[:, :2]), ValueError)
    refuses("another frame", lambda: reports[0].point_views("forearm", points), ValueError)
    refuses("fourarm", lambda: robot.points_on("fourarm", 3))


def test_a_camera_comes_from_opencvs_matrix():
    K = [[600, 0, 320], [0, 610, 240], [0, 0, 1]]
    camera = penumbra.Camera.from_matrix(K, (640, 480), [0.1, -0.2, 0, 0, 0.05])
    k = camera.intrinsics
    assert (k.width, k.height, k.fx, k.fy, k.cx, k.cy) == (640, 480, 600, 610, 320, 240)
    assert camera.distortion.model.name == "plumb_bob"
    assert penumbra.Camera.from_matrix(np.array(K), (640, 480)).distortion.is_none
    K[0][1] = 1
    refuses("K", lambda: penumbra.Camera.from_matrix(K, (640, 480)), ValueError)


def test_joints_may_be_named(shipped):
    frame = shipped.frames[4]
    robot = shipped.session.robot
    by_order = shipped.session.process(frame).labels.copy()
    named = dict(zip(robot.variables, frame.pose.positions))
    assert np.array_equal(by_order, shipped.session.process(frame.replace(pose=penumbra.pose_of(robot, named))).labels)
    refuses("tail", lambda: penumbra.pose_of(robot, named | {"tail": 1.0}), KeyError)
    named.popitem()
    refuses("missing", lambda: penumbra.pose_of(robot, named), KeyError)
    assert robot.find_variable(robot.variables[2]) == 2


def test_what_the_command_line_notes_is_noted(opened):
    session = opened.session
    for frame in opened.frames:
        session.process(frame)
    assert session.warnings() == opened.robot.notes
    degrees = np.rad2deg(opened.frames[4].pose.positions)
    session.process(opened.frames[4].replace(pose=degrees))
    assert any("radians" in note for note in session.warnings())
    session.begin_sequence()
    assert session.warnings() == opened.robot.notes
    millimetres = opened.frames[4].depth.astype(np.float32)
    session.process(opened.frames[4].replace(depth=millimetres))
    assert any("millimetres" in note for note in session.warnings())


def test_without_depth_verdicts_come_from_the_model():
    given = penumbra.open(SHIPPED)
    config = given.config.replace(has_depth=False)
    session = penumbra.Session(given.robot, given.camera, config)
    lid = penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], frame=""))
    verdicts = []
    for frame in given:
        report = session.process(penumbra.Frame(None, frame.pose.positions, targets=[lid]))
        assert report.status == penumbra.FrameStatus.ok and report.robot_mask.any()
        assert np.array_equal(report.robot_mask, report.labels == penumbra.Label.unknown)
        verdicts.append(report.targets[0].verdict)
    assert {penumbra.Verdict.visible, penumbra.Verdict.hidden} <= set(verdicts)
    assert any("no depth camera" in note for note in session.warnings())
