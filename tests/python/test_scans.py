# SPDX-License-Identifier: Apache-2.0
"""Scans of a box that slides before a wall, against closed forms and the labeller of clouds."""

import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import penumbra
from conftest import address, refuses, ROOT
from test_stages import pose

sys.path.append(str(ROOT / "tests" / "docs"))

from bag import cdr, joint_state, point_cloud, static_transform, write_bag  # noqa: E402

L = penumbra.Label
MS = 1_000_000
BEGIN = 5_000 * MS
SPEED = 2.0  # m/s
HALF = np.array([0.2, 0.2, 0.2])
CENTRE = np.array([2.0, 0.0, 0.0])  # of the box in the sensor's frame, at the joint's zero
WALL = 4.0
CONFIG = penumbra.CloudConfig(rule=penumbra.CloudRule(beam=0), T_parent_sensor=pose(-2, 0, 0))
URDF = """<robot name="slider"><link name="base"/>
    <link name="box"><collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="box"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1"/></joint></robot>"""
ROBOT = penumbra.Robot.parse(URDF, "")


def hits(rays, centre, half):
    """Where rays enter a box, in their own length; inf: they miss it."""
    a, b = (centre - half) / rays, (centre + half) / rays
    enter, leave = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
    return np.where(enter < leave, enter, np.inf)


def rays_of(columns=60, rows=60):
    """From the left to the right, 0.6 wide and high at 1 m."""
    y, z = ((np.arange(n) + 0.5) / n * 0.6 - 0.3 for n in (columns, rows))
    return np.stack([np.ones(columns * rows), np.repeat(y, rows), np.tile(z, columns)], axis=1)


def points_of(rays, *ranges):
    return (rays * np.minimum.reduce([*ranges, np.full(len(rays), WALL)])[:, None]).astype(np.float32)


RAYS = rays_of()
ON_BOX = hits(RAYS, CENTRE, HALF)
POINTS = points_of(RAYS, ON_BOX)


def test_a_box_before_a_wall():
    session = penumbra.Session(ROBOT, CONFIG)
    report = session.process(penumbra.Frame(None, [0.0], scan=penumbra.Scan(POINTS)))
    is_box = np.isfinite(ON_BOX)
    assert report.status is penumbra.FrameStatus.ok, report.message
    assert report.labels.shape == report.link_image.shape == (1, len(POINTS))
    assert np.array_equal(report.labels[0], np.where(is_box, L.occluded, L.clear))
    assert np.array_equal(report.link_image[0], 2 * is_box) and report.links[1] == "box"
    assert report.parts == 1 and report.pixels.robot == report.pixels.occluded == is_box.sum() > 400
    assert report.pixels.clear == np.count_nonzero(~is_box)
    found = penumbra.CloudLabeller(ROBOT.bodies, CONFIG.rule).label(
        POINTS, np.linalg.inv(report.T_root_camera) @ report.T_root_link, origin=[0, 0, 0])
    assert np.array_equal(found.labels, report.labels[0]) and np.array_equal(found.links, report.link_image[0])
    assert report.virtual_depth is None and report.robot_mask is None
    refuses("no image", report.without_robot, ValueError)
    refuses("no image", report.points, ValueError)
    assert session.warnings() == () and "slider" in repr(session)
    refuses("scans", lambda: session.intrinsics, RuntimeError)
    merged = session.process(penumbra.Frame(None, [0.0], scan=penumbra.Scan(POINTS, origin=None)))
    assert np.array_equal(merged.labels, report.labels)


def test_targets_are_judged_on_the_rays():
    half, aside, behind = np.full(3, 0.1), np.array([3.0, 0.6, 0.0]), np.array([3.0, 0.0, 0.0])
    scan = penumbra.Scan(points_of(RAYS, ON_BOX, hits(RAYS, aside, half)))
    targets = [penumbra.Target(name, penumbra.BoxTarget(pose(*centre), 2 * half))
               for name, centre in (("aside", aside), ("behind", behind))]
    targets.append(penumbra.Target("of root", penumbra.BoxTarget(pose(1, 0, 0), 2 * half, frame="")))
    report = penumbra.Session(ROBOT, CONFIG).process(penumbra.Frame(None, [0.0], scan=scan, targets=targets))
    V = penumbra.Verdict
    assert [target.verdict for target in report.targets] == [V.visible, V.hidden, V.hidden]
    blame = report.targets[1].judgement.blame
    assert [(b.link, b.fraction) for b in blame] == [("box", 1.0)]


def moving_scan():
    """The box moves by 0.2 m in 100 ms. Returns the scan and which points are of the box."""
    rays = rays_of(300)
    times = (np.arange(300).repeat(60) / 300 * 100 * MS).astype(np.int32)
    centres = CENTRE + SPEED * 1e-9 * times[:, None] * [0, 1, 0]
    on_box = hits(rays, centres, HALF)
    return penumbra.Scan(points_of(rays, on_box), times=times), np.isfinite(on_box)


def test_the_robot_moves_during_a_scan():
    scan, is_box = moving_scan()
    buffer = penumbra.JointBuffer(ROBOT)
    for ms in range(0, 110, 10):
        buffer.insert(BEGIN + ms * MS, ["slide"], [SPEED * 1e-3 * ms])
    frame = penumbra.Frame(None, [0.0], scan=scan, stamp=BEGIN,
                           pose_at=lambda stamp: penumbra.pose_of(ROBOT, buffer.at(stamp)))

    def process(frame):
        report = penumbra.Session(ROBOT, CONFIG).process(frame)
        return report, np.mean((report.labels[0] == L.occluded) != is_box)

    with ThreadPoolExecutor(4) as threads:
        for report, wrong in threads.map(process, [frame] * 8):
            assert report.status is penumbra.FrameStatus.ok, report.message
            assert report.parts >= 20 and wrong < 0.01
    report, wrong = process(frame.replace(pose_at=None))
    assert report.parts == 1 and wrong > 0.05
    late, wrong = process(frame.replace(stamp=BEGIN + 10 * MS))
    assert late.status is penumbra.FrameStatus.stale_joints and set(late.labels[0]) == {L.unknown}
    assert frame.replace(stamp=1).pose_at is frame.pose_at

    def fail(stamp):
        raise KeyError(stamp)

    refuses(str(BEGIN), lambda: process(frame.replace(pose_at=fail)), KeyError)
    wrong_number, _ = process(frame.replace(pose_at=lambda _: [0.0, 1.0]))
    assert wrong_number.status is penumbra.FrameStatus.missing_joints and "2 joint" in wrong_number.message
    refuses("pose_at", lambda: frame.replace(pose_at=3), TypeError)
    for returns in (buffer.at, lambda _: {"slide": 0.0}):
        refuses("pose_at: expected a penumbra.RobotPose.*got (JointAnswer|dict)",
                lambda: process(frame.replace(pose_at=returns)), TypeError)


def test_a_scan_keeps_its_arrays():
    points, times = POINTS.copy(), np.zeros(len(POINTS), np.int32)
    lies_at = address(points), address(times)
    scan = penumbra.Scan(points, times=times)
    del points, times
    frame = penumbra.Frame(None, [0.0], scan=scan)
    del scan
    assert (address(frame.scan.points), address(frame.scan.times)) == lies_at
    kept = frame.scan.points
    del frame
    assert np.array_equal(kept, POINTS) and not kept.flags.writeable
    wide = np.zeros((5, 6), np.float32)
    assert penumbra.Scan(wide[::2]).points.shape == (3, 3) and penumbra.Scan(wide).times is None


def test_other_arrays_are_refused_and_bad_scans_are_unknown():
    refuses("points: expected", lambda: penumbra.Scan([[0, 0, 1]]), TypeError)
    refuses("times: expected numpy.ndarray of int32", lambda: penumbra.Scan(POINTS, times=[1]), TypeError)
    report = penumbra.Session(ROBOT, CONFIG).process(
        penumbra.Frame(None, [0.0], scan=penumbra.Scan(POINTS, times=np.zeros(2, np.int32))))
    assert report.status is not penumbra.FrameStatus.ok and "2 times for 3600 points" in report.message
    assert set(report.labels[0]) == {L.unknown}
    refuses("nobody", lambda: penumbra.Session(ROBOT, CONFIG.replace(sensor_parent="nobody")))


def check_opened(given, clouds):
    """Frames come one after the other and by number, and are judged as frames of one's own."""
    assert given.cloud is not None and given.robot.name == "slider"
    refuses("sensor of points", lambda: given.camera, ValueError)
    refuses("sensor of points", lambda: given.config, ValueError)
    frames, session = iter(given), penumbra.Session(given.robot, given.cloud)
    for i, points in enumerate(clouds):
        frame = next(frames)
        report = session.process(frame)
        assert report.status is penumbra.FrameStatus.ok, report.message
        assert np.array_equal(frame.scan.points, points) and frame.scan.points.base is not None
        assert np.count_nonzero(report.labels[0] == L.occluded) > 400
        assert np.array_equal(given[i].scan.points, points)
    assert next(frames, None) is None
    refuses("fewer", lambda: given[len(clouds)], IndexError)
    assert np.array_equal(frame.scan.points, clouds[-1]), "frames keep their points"
    return report


def test_open_reads_folders_of_clouds(tmp_path):
    clouds = [points_of(RAYS, hits(RAYS, CENTRE + [0, y, 0], HALF)) for y in (0.0, 0.1, 0.2)]
    (tmp_path / "robot.urdf").write_text(URDF)
    np.savetxt(tmp_path / "pose.csv", CONFIG.T_parent_sensor, delimiter=",")
    (tmp_path / "joints.csv").write_text("frame,slide\n0,0\n1,0.1\n2,0.2\n")
    for i, points in enumerate(clouds):
        np.save(tmp_path / f"cloud_{i}.npy", points)
    (tmp_path / "recording.yaml").write_text(
        "robot: {urdf: robot.urdf}\nsensor: {pose: pose.csv, beam: 0}\n"
        "frames: {joints: joints.csv, cloud: cloud_%d.npy}\n")
    given = penumbra.open(tmp_path)
    assert len(given) == 3
    report = check_opened(given, clouds)
    assert report.index == 2 and np.array_equal(report.labels[0] == L.occluded, clouds[2][:, 0] < 0.9 * WALL)


def test_open_reads_the_clouds_of_bags(tmp_path):
    scan, is_box = moving_scan()
    rows = np.concatenate([scan.points, (scan.times * 1e-9).astype(np.float32)[:, None]], axis=1)
    cloud = point_cloud(rows, ["x", "y", "z", "time"], "lidar", BEGIN)
    mount = static_transform("base", "lidar", CONFIG.T_parent_sensor, BEGIN)
    messages = [("/robot_description", "std_msgs/msg/String", BEGIN, cdr(URDF)),
                ("/tf_static", "tf2_msgs/msg/TFMessage", BEGIN, mount)]
    messages += [("/joint_states", "sensor_msgs/msg/JointState", BEGIN + ms * MS,
                  joint_state(["slide"], [SPEED * 1e-3 * ms], BEGIN + ms * MS)) for ms in range(0, 120, 10)]
    messages += [(topic, "sensor_msgs/msg/PointCloud2", BEGIN + 110 * MS, cloud) for topic in ("/front", "/rear")]
    write_bag(tmp_path / "run.mcap", messages)
    given = penumbra.open(tmp_path / "run.mcap", bag=penumbra.BagOptions(clouds=True, cloud_topics=["/rear"]))
    report = check_opened(given, [scan.points])
    assert np.allclose(report.T_root_camera, CONFIG.T_parent_sensor)
    assert report.parts >= 20, "the poses during the scan are the bag's"
    assert np.mean((report.labels[0] == L.occluded) != is_box) < 0.02
    frame = given[0]
    assert frame.pose_at(BEGIN + 50 * MS).positions == pytest.approx((0.1,))
    assert frame.replace(stamp=frame.stamp).pose_at is frame.pose_at
    refuses("/front, /rear", lambda: penumbra.open(tmp_path / "run.mcap", bag=penumbra.BagOptions(clouds=True)))
