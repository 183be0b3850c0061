# SPDX-License-Identifier: Apache-2.0
"""What a program records is a recording: the same frames, judged the same."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest

import penumbra
from conftest import read_png, refuses, run, SHIPPED


@pytest.fixture(scope="module")
def given():
    return penumbra.open(SHIPPED, color=True)


@pytest.fixture(scope="module")
def frames(given):
    return list(given)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "recording"


def record(out, given, frames, **options):
    with penumbra.Recorder(out, given.robot, given.camera, given.config, **options) as recorder:
        for frame in frames:
            recorder.add(frame.depth, frame.pose, color=frame.color, stamp=frame.stamp)
    return out


def judged(folder, result, *options):
    """report.json and the label images of a run."""
    run("run", folder, "-o", result, "--save", "labels", *options)
    report = json.loads((result / "report.json").read_text())
    return report, [read_png(file) for file in sorted((result / "labels").glob("*.png"))]


def test_a_recording_is_judged_as_its_original(out, given, frames, tmp_path):
    record(out, given, frames, targets=SHIPPED / "targets.yaml")
    original, labels = judged(SHIPPED, tmp_path / "original")
    report, same = judged(out, tmp_path / "out", "--report")
    assert len(labels) == 12 and np.array_equal(labels, same)
    assert (tmp_path / "out" / "report.html").exists()
    for frame in [*original["frames"], *report["frames"]]:
        del frame["timing_ms"]
    assert report["frames"] == original["frames"] and report["links"] == original["links"]


def test_depth_may_be_metres(out, given, frames):
    depth = np.where(frames[0].depth == 0, np.nan, frames[0].depth / np.float32(1000)).astype(np.float32)
    with penumbra.Recorder(out, given.robot, given.camera, given.config) as recorder:
        assert [recorder.add(depth, frames[0].pose.positions), recorder.add(depth, None)] == [0, 1]
    back = penumbra.open(out)[0]
    assert back.depth.dtype == np.float32 and np.array_equal(back.depth, depth, equal_nan=True)
    assert back.stamp is None and not list(out.rglob("*.part"))


def test_arrays_of_a_whole_sequence(out, given, frames):
    depths = np.stack([frame.depth for frame in frames[:3]])
    named = [dict(zip(given.robot.variables, frame.pose.positions)) for frame in frames[:3]]
    read = penumbra.from_arrays(out, given.robot, given.camera, given.config, depths, named,
                                 colors=[None, frames[1].color, None], stamps=np.arange(3))
    assert [frame.stamp for frame in read] == [0, 1, 2]
    assert all(np.array_equal(a.pose.positions, b.pose.positions) for a, b in zip(read, frames))
    assert [frame.color is None for frame in read] == [True, False, True]
    assert np.array_equal(read[1].color, frames[1].color) and np.array_equal(read[1].depth, frames[1].depth)
    refuses("'joints': 2", lambda: penumbra.from_arrays(
        out, given.robot, given.camera, given.config, depths, named[:2]), ValueError)


def test_setup_and_settings_are_kept(out, given, frames, tmp_path):
    tool = tmp_path / "tool.obj"
    tool.write_text("v 0 0 0\nv .2 0 0\nv 0 .2 0\nv 0 0 .2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    options = given.robot.options.replace(
        geometry=penumbra.Geometry.visual, geometry_of_links={"wrist_1_link": penumbra.Geometry.collision},
        ignore_links=["flange"], margins={"fore*": 0.01},
        extra=[penumbra.ExtraMesh(link="gripper", mesh=tool)])
    robot = penumbra.Robot.load(given.robot.urdf, options)
    lens = penumbra.Distortion("rational_polynomial", [0.1, -0.05, 1e-5, -2e-4, 0.01, 0.02, 0.03, -0.01])
    camera = penumbra.Camera(given.camera.intrinsics, distortion=lens, frame_id='my "camera": 1',
                             range=penumbra.DepthRange(near=0.3, far=9),
                             T_parent_camera=given.camera.T_parent_camera)
    rule = penumbra.LabelRule(tolerance=penumbra.Tolerance(a=0.02), fringe_reach=11, beyond_factor=1.5,
                              front_min_width=3, edge_margin=4, range=penumbra.DepthRange(near=0.1, far=4))
    config = given.config.replace(rule=rule)
    frame = frames[4]
    with penumbra.Recorder(out, robot, camera, config) as recorder:
        recorder.add(frame.depth, frame.pose)
    read = penumbra.open(out)
    kept = read.camera
    assert (kept.parent, kept.range.near, kept.range.far) == ("base_link", 0.3, 4)
    assert kept.frame_id == camera.frame_id and kept.intrinsics == camera.intrinsics
    assert np.array_equal(kept.distortion.coefficients, lens.coefficients)
    assert np.array_equal(kept.T_parent_camera, camera.T_parent_camera)
    again = penumbra.Session(read.robot, kept, read.config)
    report = penumbra.Session(robot, camera, config).process(frame)
    assert np.array_equal(again.process(frame).labels, report.labels) and report.pixels.fringe
    # All settings of the rule but those that the commands have.
    keys = {name for name, value in vars(penumbra.LabelRule).items() if isinstance(value, property)}
    assert keys - {"fold_beyond", "range"} == {*penumbra.recorder.rule_keys, "tolerance"}


def test_faults_of_frames_are_recorded(out, given, frames, tmp_path):
    depth, joints = frames[0].depth, frames[0].pose.positions
    unknown = penumbra.JointBuffer(given.robot).at(5)
    with penumbra.Recorder(out, given.robot, given.camera, given.config) as recorder:
        for joints_of_frame in (joints, None, [np.nan, *joints[1:]], unknown):
            recorder.add(depth, joints_of_frame)
        recorder.add(None, joints)
    report, labels = judged(out, tmp_path / "out")
    assert [frame["status"] for frame in report["frames"]] == [
        "ok", "missing_joints", "missing_link", "missing_joints", "missing_depth"]
    assert given.robot.variables[0] in report["frames"][2]["message"]
    assert (labels[2] == penumbra.Label.unknown).any(), "where the first joint could move the arm"
    assert (labels[3] == penumbra.Label.unknown).all()


BAD_FRAMES = [
    (lambda depth, joints: (depth[:-1], joints), ValueError, r"depth: expected shape \(480, 640\)"),
    (lambda depth, joints: (depth.astype(float), joints), TypeError, "float32"),
    (lambda depth, joints: (depth.astype(np.float32), joints), ValueError, "uint16 as before"),
    (lambda depth, joints: (depth, joints[:-1]), ValueError, "expected 7 positions"),
    (lambda depth, joints: (depth, {"tail": 1.0}), KeyError, "tail"),
    (lambda depth, joints: (depth, joints, np.zeros((480, 640), np.uint8)), ValueError, "color"),
    (lambda depth, joints: (depth, joints, np.zeros((480, 640, 3))), ValueError, "color"),
    (lambda depth, joints: (depth, joints, [1, 2]), ValueError, "color"),
    (lambda depth, joints: (depth, joints, None, 2), ValueError, "stamp"),
    (lambda depth, joints: (depth, joints, None, -1), ValueError, "stamp"),
    (lambda depth, joints: (depth, joints, None, 1.5), TypeError, "stamp"),
]


@pytest.mark.parametrize("bad, error, says", BAD_FRAMES)
def test_frames_that_are_no_frames_are_refused_and_not_written(out, given, frames, bad, error, says):
    good = frames[0].depth, frames[0].pose.positions
    with penumbra.Recorder(out, given.robot, given.camera, given.config) as recorder:
        recorder.add(*good)
        refuses(says, lambda: recorder.add(*bad(*good)), error)
        assert recorder.add(*good) == 1
    refuses("closed", lambda: recorder.add(*good), ValueError)
    assert len(list(penumbra.open(out))) == 2
    assert not list(out.rglob("*.part"))


def test_setups_that_cannot_be_recorded_are_input_errors(out, given, frames, tmp_path):
    def refused(says, folder=out, robot=given.robot, targets=None, **changes):
        camera = given.camera.replace(**changes)
        refuses(says, lambda: penumbra.Recorder(folder, robot, camera, given.config, targets=targets))

    refused("no file", targets=tmp_path / "targets.yaml")
    refused("nowhere", parent="nowhere")
    refused("rigid", T_parent_camera=np.diag([2.0, 2, 2, 1]))
    refused("pose is missing", T_parent_camera=None)
    refused("Robot.load", robot=penumbra.Robot.join([("one", given.robot, np.eye(4))]))
    refused("cannot be written", folder="/proc/recording")
    record(out, given, frames[:1])  # the folder is there, and still empty
    refused("is not empty")
    (tmp_path / "file").touch()
    refused("cannot be written", folder=tmp_path / "file")
    assert len(list(penumbra.open(out))) == 1


LOOP = """
import sys, penumbra
given = penumbra.open(sys.argv[1], color=True)
frames = list(given)
recorder = penumbra.Recorder(sys.argv[2], given.robot, given.camera, given.config)
while True:
    for frame in frames:
        print(recorder.add(frame.depth, frame.pose.positions, frame.color), flush=True)
"""


@pytest.mark.parametrize("count", [1, 5, 14])
def test_a_killed_program_leaves_its_frames(out, count, tmp_path):
    with subprocess.Popen([sys.executable, "-c", LOOP, SHIPPED, out], stdout=subprocess.PIPE, text=True) as loop:
        for _ in range(count):
            loop.stdout.readline()
        loop.send_signal(signal.SIGKILL)
        written = count + len(loop.stdout.readlines())
    report, _ = judged(out, tmp_path / "out")
    statuses = [frame["status"] for frame in report["frames"]]
    assert statuses[:written] == ["ok"] * written
    assert len(statuses) <= written + 1  # the one that was interrupted


def test_png_files_hold_the_pixels(tmp_path):
    file = tmp_path / "image.png"
    random = np.random.default_rng(1)
    for image in (random.integers(0, 1 << 16, (7, 5), np.uint16), random.integers(0, 256, (7, 5), np.uint8),
                  random.integers(0, 256, (7, 5, 3), np.uint8), random.integers(0, 256, (7, 9, 4), np.uint8)[:, ::2, :3],
                  np.ndarray((7, 5, 3), np.uint8, random.bytes(7 * 16), strides=(16, 3, 1))):
        penumbra.write_png(file, image)
        assert np.array_equal(read_png(file), image)
    penumbra.write_png(file, image[..., 0] > 99)
    assert np.array_equal(read_png(file), np.where(image[..., 0] > 99, 255, 0))
    for wrong in (np.zeros((7, 5)), np.zeros((7, 5, 3), np.uint16), [[1]]):
        refuses("image: expected", lambda: penumbra.write_png(file, wrong), (TypeError, ValueError))
    refuses("nowhere", lambda: penumbra.write_png(tmp_path / "nowhere" / "image.png", np.zeros((7, 5), np.uint8)))
