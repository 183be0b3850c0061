# SPDX-License-Identifier: Apache-2.0
"""Recordings of the files that people have, written by others' libraries."""

import json
import os
import shutil

import numpy as np
from PIL import Image
import pytest

import penumbra
from conftest import execute, run, SHIPPED

FRAMES = 12


@pytest.fixture(scope="module")
def images():
    depth = [np.asarray(Image.open(SHIPPED / f"depth/{i}.png")).astype(np.uint16) for i in range(FRAMES)]
    color = [np.asarray(Image.open(SHIPPED / f"color/{i}.png").convert("RGB")) for i in range(FRAMES)]
    return depth, color


@pytest.fixture
def recording(tmp_path):
    """Makes the shipped recording with other names of its images; `camera`: a line of its camera."""
    def make(depth="depth/%d.png", color="color/%d.png", camera=""):
        folder = tmp_path / "recording"
        shutil.copytree(SHIPPED, folder, ignore=shutil.ignore_patterns("truth"))
        text = (folder / "recording.yaml").read_text()
        text = text.replace("depth/%d.png", depth).replace("color/%d.png", color)
        text = text.replace("camera:\n", f"camera:\n  {camera}\n", 1)
        (folder / "recording.yaml").write_text(text)
        return folder
    return make


def frames_of(folder):
    return [given.depth for given in penumbra.open(folder)]


def judge(folder, status=0):
    """What is printed of a run's faults."""
    return run("run", folder, "-o", folder.parent / "out", status=status).stderr


def ffmpeg(*words):
    execute("ffmpeg", "-v", "error", "-y", *words)


def lossless_depth(file, count=FRAMES):
    ffmpeg("-framerate", 10, "-i", SHIPPED / "depth/%d.png", "-frames:v", count, "-c:v", "ffv1",
           "-pix_fmt", "gray16le", file)


def save_tiff(file, pixels, **options):
    Image.fromarray(pixels).save(file, **options)


def save_npy(file, pixels):
    with file.open("wb") as out:
        np.save(out, pixels)


# How to write a depth image in millimetres.
KINDS = {
    "tiff": save_tiff,
    "deflated tiff": lambda file, depth: save_tiff(file, depth, compression="tiff_deflate"),
    "32-bit tiff": lambda file, depth: save_tiff(file, depth.astype(np.int32)),
    "tiff of metres": lambda file, depth: save_tiff(file, (depth / 1000).astype(np.float32)),
    "npy": save_npy,
    "npy of int64": lambda file, depth: save_npy(file, depth.astype(np.int64)[..., None]),
    "npy of metres": lambda file, depth: save_npy(file, depth / 1000),
    "npy of 0.1 mm": lambda file, depth: save_npy(file, depth.astype(np.int32) * 10),
}


@pytest.mark.parametrize("kind", KINDS)
def test_integers_are_millimetres_and_floats_metres(recording, images, kind):
    ending = "npy" if "npy" in kind else "tiff"
    folder = recording(f"depth/%d.{ending}", camera="depth_scale: 0.0001" if "0.1" in kind else "")
    for i, depth in enumerate(images[0]):
        KINDS[kind](folder / f"depth/{i}.{ending}", depth)
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        assert "of metres" not in kind or read.dtype == np.float32
        np.testing.assert_allclose(read * (0.001 if read.dtype == np.uint16 else 1), depth / 1000, rtol=1e-6)


def test_a_jpeg_is_a_colour_image(recording, images):
    folder = recording(color="color/%d.jpg")
    for i, color in enumerate(images[1]):
        Image.fromarray(color).save(folder / f"color/{i}.jpg", quality=95)
    for given, color in zip(penumbra.open(folder, color=True), images[1], strict=True):
        assert np.abs(given.color.astype(int) - color).mean() < 3  # what JPEG of this quality loses


def test_a_video_gives_frames_in_any_order(recording, images):
    folder = recording(color="color.mp4")
    # Pictures between key frames, shown in another order than they are stored.
    ffmpeg("-framerate", 29.97, "-i", SHIPPED / "color/%d.png", "-c:v", "libx264", "-g", 5, "-bf", 2,
           "-pix_fmt", "yuv420p", "-crf", 5, folder / "color.mp4")
    frames = penumbra.open(folder, color=True)
    for i in [0, 7, 3, 11, 10, 1, 6, 5, 4]:
        off = [np.abs(frames[i].color.astype(int) - color).mean() for color in images[1]]
        assert np.argmin(off) == i


OTHER_DEPTH = {  # a word of the fault, and how to make it
    "tiff of 8 bits": ("8 bits", lambda file, depth: save_tiff(file, depth.astype(np.uint8))),
    "jpeg": ("JPEG", lambda file, depth: save_tiff(file, depth.astype(np.uint8), format="jpeg")),
    "cut tiff": ("damaged", lambda file, depth: (save_tiff(file, depth), os.truncate(file, 20000))),
    "text": ("no depth image", lambda file, depth: file.write_text("depth")),
    "tiff of another size": ("320 x 240", lambda file, depth: save_tiff(file, depth[::2, ::2])),
    "npy of bool": ("b1", lambda file, depth: save_npy(file, depth > 0)),
    "fifo": ("regular file", lambda file, depth: os.mkfifo(file)),
}


def test_other_depth_is_refused(recording, images):
    folder = recording("depth/%d.tiff")
    file = folder / "depth/0.tiff"
    for says, make in OTHER_DEPTH.values():
        file.unlink(missing_ok=True)
        make(file, images[0][0])
        told = judge(folder, 2)
        assert "0.tiff" in told and says in told


OTHER_VIDEOS = {
    "missing": ("cannot be read", lambda file: None),
    "text": ("no video", lambda file: file.write_text("depth")),
    "8 bits": ("16-bit grey", lambda file: ffmpeg("-i", SHIPPED / "color/%d.png", "-c:v", "ffv1", file)),
    "other size": ("320 x 240", lambda file: ffmpeg(
        "-i", SHIPPED / "depth/%d.png", "-vf", "scale=320:240", "-c:v", "ffv1", "-pix_fmt", "gray16le", file)),
}


def test_other_videos_are_refused(recording):
    folder = recording("depth.mkv")
    for says, make in OTHER_VIDEOS.values():
        make(folder / "depth.mkv")
        told = judge(folder, 2)
        assert "depth.mkv" in told and says in told


def test_a_video_of_depth_loses_nothing_and_needs_ffmpeg_and_all_frames(recording, images, monkeypatch):
    folder = recording("depth.mkv")
    lossless_depth(folder / "depth.mkv")
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        np.testing.assert_array_equal(read, depth)
    lossless_depth(folder / "depth.mkv", FRAMES - 2)
    told = judge(folder)
    assert "depth.mkv" in told and "missing_depth in 2 of 12 frames" in told
    monkeypatch.setenv("PATH", str(folder))
    assert "ffprobe" in judge(folder, 2)


def test_depth_of_a_camera_of_its_own(recording, images):
    """The same camera 20 cm to the right sees the arm elsewhere; registered, it is where it was."""
    folder = recording(camera="depth_info: camera_info.yaml\n  depth_pose: depth_pose.csv")
    (folder / "depth_pose.csv").write_text("1,0,0,0\n0,1,0,0\n0,0,1,0\n0,0,0,1\n")
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        same = (read == depth).mean()
        assert same > 0.999  # the footprint of a pixel's neighbour may win at a step
    (folder / "depth_pose.csv").write_text("1,0,0,0.2\n0,1,0,0\n0,0,1,0\n0,0,0,1\n")
    moved = frames_of(folder)[0]
    assert (moved == images[0][0]).mean() < 0.5
    (folder / "depth_pose.csv").unlink()
    assert "depth_pose.csv" in judge(folder, 2)


@pytest.fixture
def folder(tmp_path):
    """The shipped recording's files without what says how they belong together."""
    folder = tmp_path / "mine"
    shutil.copytree(SHIPPED, folder, ignore=shutil.ignore_patterns("truth", "recording.yaml"))
    return folder


def test_init_finds_what_a_recording_has(folder):
    told = run("init", folder).stdout
    assert "penumbra run" in told and "parent" in told
    made, shipped = (penumbra.open(each, color=True) for each in (folder, SHIPPED))
    assert made.camera.parent == shipped.camera.parent
    for ours, theirs in zip(made, shipped, strict=True):
        np.testing.assert_array_equal(ours.depth, theirs.depth)
        np.testing.assert_array_equal(ours.color, theirs.color)
        assert ours.stamp == theirs.stamp
    assert "--force" in run("init", folder, status=2).stderr
    run("init", folder, "--force")


def test_init_names_a_detectors_file(folder):
    (folder / "targets.yaml").unlink()
    box = {"image_id": 0, "category_id": 39, "bbox": [460, 172, 38, 98], "score": 0.9}
    (folder / "results.json").write_text(json.dumps([box]))
    (folder / "notes.json").write_text('{"taken": "by hand"}')
    run("init", folder)
    assert 'targets: "results.json"' in (folder / "recording.yaml").read_text()


def test_init_says_what_is_missing(folder):
    (folder / "camera_pose.csv").unlink()
    (folder / "joint_states.csv").write_text("frame,elbow\n0,1\n")
    told = run("init", folder).stdout
    assert "calibrate" in told.splitlines()[-1] and "--search" in told
    assert "joints: " in told and "pose: " in told
    assert "# pose: " in (folder / "recording.yaml").read_text()


@pytest.mark.parametrize("name", ["arm.urdf.xacro", "arm.XML"])
def test_init_finds_other_robots(folder, name):
    (folder / "arm_description/arm.urdf").unlink()
    (folder / "other.xml").write_text("<!-- <mujoco> --><mujocoinclude/>")
    (folder / "text.xml").write_text("mujoco")
    assert "MJCF" in run("init", folder, status=2).stderr
    limits = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
    urdf = '<robot name="r"><link name="world"/><link name="arm"/><joint name="j" type="revolute">' \
           f'<parent link="world"/><child link="arm"/>{limits}</joint></robot>'
    mjcf = '<?xml version="1.0"?>\n<!-- a > <robot> -->\n<mujoco>' \
           '<worldbody><body name="arm"><joint name="j"/><geom size="1"/></body></worldbody></mujoco>'
    (folder / name).write_text(urdf if "xacro" in name else mjcf)
    run("init", folder)
    assert f'urdf: "{name}"' in (folder / "recording.yaml").read_text()
    shutil.copy(folder / name, folder / f"second_{name}")
    assert "--robot" in run("init", folder, "--force", status=2).stderr
    shutil.copy(SHIPPED / "arm_description/arm.urdf", folder / "arm.urdf")
    run("init", folder, "--force")
    assert 'urdf: "arm.urdf"' in (folder / "recording.yaml").read_text()


def test_init_needs_one_robot(folder):
    urdf = folder / "arm_description/arm.urdf"
    shutil.copy(urdf, folder / "other.urdf")
    assert "--robot" in run("init", folder, status=2).stderr
    run("init", folder, "--robot", urdf)
