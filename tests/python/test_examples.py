# SPDX-License-Identifier: Apache-2.0
"""The examples run, and what they write is right."""

import pathlib
import re
import shutil

import numpy as np
import pytest

import penumbra
from conftest import Opened, ROOT, run_python, SHIPPED

EXAMPLES = ROOT / "examples" / "python"


def run(name, *arguments):
    return run_python(EXAMPLES / name, *arguments).stdout


def robot_of(report):
    return (report.labels != penumbra.Label.clear) & (report.labels != penumbra.Label.front)


def test_each_example_is_short_and_run():
    tests = pathlib.Path(__file__).read_text() + (ROOT / "examples" / "CMakeLists.txt").read_text()
    examples = [*EXAMPLES.glob("*.py"), *(ROOT / "examples").glob("*.cpp")]
    assert len(examples) > 10
    for example in examples:
        assert len(example.read_text().splitlines()) < 40, example
        name = example.name if example.suffix == ".py" else f"penumbra_example({example.stem} "
        assert name in tests, example


def test_mask_depth_takes_ten_lines_and_masks_the_robot(tmp_path):
    lines = (EXAMPLES / "mask_depth.py").read_text().splitlines()
    start = lines.index("import penumbra")
    assert len([line for line in lines[start:] if line]) <= 10
    run("mask_depth.py", SHIPPED, tmp_path)
    opened = Opened(SHIPPED)
    for frame in opened.frames:
        is_robot = robot_of(opened.session.process(frame))
        masked = np.load(tmp_path / f"{frame.index:06d}.npy")
        points = np.load(tmp_path / f"{frame.index:06d}_points.npy")
        assert points.dtype == np.float32 and points.shape == (np.count_nonzero(masked), 3)
        assert masked.dtype == np.uint16 and is_robot.any()
        assert np.array_equal(masked, np.where(is_robot, 0, frame.depth))


def test_filter_cloud_keeps_what_is_not_the_robot(tmp_path):
    told = run("filter_cloud.py", SHIPPED, tmp_path)
    assert len(list(tmp_path.glob("*.ply"))) == told.count("points") == 12
    data = (tmp_path / "000004.ply").read_bytes()
    head, body = data.split(b"end_header\n")
    points = np.frombuffer(body, [("p", "<f4", 3), ("c", "u1", 3)])
    assert f"element vertex {len(points)}".encode() in head
    opened = Opened(SHIPPED)
    frame = opened.frames[4]
    kept = ~robot_of(opened.session.process(frame)) & (frame.depth > 0)
    assert len(points) == np.count_nonzero(kept)
    # A pixel by hand: its ray times its depth, from the camera to the root link.
    v, u = np.argwhere(kept)[1000]
    p = opened.camera.intrinsics.ray(u, v) * frame.depth[v, u] / 1000
    T = opened.camera.T_parent_camera
    assert np.allclose(points["p"][1000], T[:3, :3] @ p + T[:3, 3], atol=1e-4)
    # Most of what is left is table and floor: nothing hangs in the air where the arm was.
    assert np.median(points["p"][:, 2]) < 0.3


def test_plot_occlusion_draws(tmp_path):
    pytest.importorskip("matplotlib")
    from matplotlib import image

    run("plot_occlusion.py", SHIPPED, tmp_path / "occlusion.png")
    drawn = image.imread(tmp_path / "occlusion.png")
    assert drawn.shape[1] > 600 and len(np.unique(drawn.reshape(-1, drawn.shape[2]), axis=0)) > 50


def test_batch_folder_judges_all_and_tells_what_fails(tmp_path):
    for name in ("a", "b"):
        shutil.copytree(SHIPPED, tmp_path / "in" / name)
    told = run("batch_folder.py", tmp_path / "in", tmp_path / "out")
    assert told.count("done") == 2 and "2 of 2 judged" in told
    assert len(list((tmp_path / "out").rglob("*.npz"))) == 24
    opened = Opened(SHIPPED)
    report = opened.session.process(opened.frames[5])
    assert np.array_equal(np.load(tmp_path / "out" / "b" / "000005.npz")["depth"], report.without_robot())
    (tmp_path / "in" / "a" / "joint_states.csv").unlink()
    done = run_python(EXAMPLES / "batch_folder.py", tmp_path / "in", tmp_path / "out", status=2)
    assert "joint_states.csv" in done.stderr and "1 of 2" in done.stdout


def test_calibrate_writes_the_pose(tmp_path):
    assert "within" in run("calibrate.py", SHIPPED, tmp_path / "pose.csv")
    found = np.loadtxt(tmp_path / "pose.csv", delimiter=",")
    assert np.allclose(found, Opened(SHIPPED).camera.T_parent_camera, atol=0.01)


def test_pick_and_place_holds_the_part_where_it_is():
    told = [re.match(r"(\d+) (\w+) \[ *(\S+) +(\S+) +(\S+) *\] ?(.*)", line).groups()
            for line in run("pick_and_place.py").splitlines()]
    given = penumbra.open(SHIPPED)
    poses = [given.robot.forward_kinematics(frame.pose.positions)[given.robot.find_link("gripper")] for frame in given]
    place = np.array([0.634, -0.041, 0.22, 1])
    for i, (index, verdict, *position, reason) in enumerate(told):
        carried = poses[min(max(i, 3), 8)] @ np.linalg.inv(poses[3]) @ place
        assert int(index) == i and np.allclose(np.array(position, float), carried[:3], atol=0.6e-3)  # printed in mm
        assert (verdict == "held") == (4 <= i <= 8) and (verdict != "held" or "link 'gripper'" in reason)
    assert len(told) == 12 and told[-1][1] == "visible"


def test_ways_to_a_grasp_are_ranked():
    told = run("rank_grasps.py").splitlines()
    assert told[0].startswith("over the top") and "100 % seen" in told[0]
    assert told[-1].startswith("straight") and "behind" in told[-1]


def test_a_planner_keeps_the_target_in_view():
    words = [line.split() for line in run("plan_in_view.py").splitlines()]
    length = [float(line[3]) for line in words]
    seen = [float(line[-2]) for line in words]
    assert seen[0] < 80 and seen[-1] > 98  # the shortest path passes before the target
    assert length[0] <= min(length[1:]) and length[-1] < 1.2 * length[0]
