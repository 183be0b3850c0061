# SPDX-License-Identifier: Apache-2.0
"""Recordings of the files that people have, written by others' libraries."""

import json
import shutil
import subprocess

import numpy as np
from PIL import Image
import pytest

import penumbra
from conftest import PROGRAM, SHIPPED

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
    return [given.frame.depth for given in penumbra.open_input(folder)]


def run(folder):
    command = [PROGRAM, "run", folder, "-o", folder.parent / "out"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def ffmpeg(*words):
    subprocess.run(["ffmpeg", "-v", "error", "-y", *map(str, words)], check=True)


def lossless_depth(file, count=FRAMES):
    ffmpeg("-framerate", 10, "-i", SHIPPED / "depth/%d.png", "-frames:v", count, "-c:v", "ffv1",
           "-pix_fmt", "gray16le", file)


@pytest.mark.parametrize("kind", ["tiff", "deflated tiff", "32-bit tiff", "npy", "npy of int64"])
def test_integers_are_millimetres(recording, images, kind):
    ending = ".npy" if "npy" in kind else ".tiff"
    folder = recording(f"depth/%d{ending}")
    for i, depth in enumerate(images[0]):
        file = folder / f"depth/{i}{ending}"
        if kind == "npy":
            np.save(file, depth)
        elif kind == "npy of int64":
            np.save(file, depth.astype(np.int64)[..., None])
        else:
            pixels = depth.astype(np.int32) if kind == "32-bit tiff" else depth
            Image.fromarray(pixels).save(file, compression="tiff_deflate" if "deflated" in kind else None)
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        scale = 1 if read.dtype == np.uint16 else 1000
        np.testing.assert_allclose(read * scale, depth, rtol=1e-6)


@pytest.mark.parametrize("kind", ["tiff", "npy of float64"])
def test_floats_are_metres(recording, images, kind):
    folder = recording("depth/%d.tiff" if kind == "tiff" else "depth/%d.npy")
    for i, depth in enumerate(images[0]):
        if kind == "tiff":
            Image.fromarray((depth / 1000).astype(np.float32)).save(folder / f"depth/{i}.tiff")
        else:
            np.save(folder / f"depth/{i}.npy", depth / 1000)
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        assert read.dtype == np.float32
        np.testing.assert_allclose(read, depth / 1000, rtol=1e-6)


def test_depth_scale_is_of_every_kind(recording, images):
    folder = recording("depth/%d.npy", camera="depth_scale: 0.0001")
    for i, depth in enumerate(images[0]):
        np.save(folder / f"depth/{i}.npy", depth.astype(np.int32) * 10)
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        np.testing.assert_allclose(read, depth / 1000, rtol=1e-6)


def test_a_jpeg_is_a_colour_image(recording, images):
    folder = recording(color="color/%d.jpg")
    for i, color in enumerate(images[1]):
        Image.fromarray(color).save(folder / f"color/{i}.jpg", quality=95)
    for given, color in zip(penumbra.open_input(folder, color=True), images[1], strict=True):
        assert np.abs(given.color.astype(int) - color).mean() < 3  # what JPEG of this quality loses


def test_a_video_of_depth_loses_nothing(recording, images):
    folder = recording("depth.mkv")
    lossless_depth(folder / "depth.mkv")
    for read, depth in zip(frames_of(folder), images[0], strict=True):
        np.testing.assert_array_equal(read, depth)


def test_a_video_gives_frames_in_any_order(recording, images):
    folder = recording(color="color.mp4")
    # Pictures between key frames, shown in another order than they are stored.
    ffmpeg("-framerate", 29.97, "-i", SHIPPED / "color/%d.png", "-c:v", "libx264", "-g", 5, "-bf", 2,
           "-pix_fmt", "yuv420p", "-crf", 5, folder / "color.mp4")
    opened = penumbra.Recording.open(folder)
    frames = penumbra.FrameReader(opened, opened.load_robot(), color=True)
    for i in [0, 7, 3, 11, 10, 1, 6, 5, 4]:
        off = [np.abs(frames[i].color.astype(int) - color).mean() for color in images[1]]
        assert np.argmin(off) == i


def test_a_short_video_is_said(recording):
    folder = recording("depth.mkv")
    lossless_depth(folder / "depth.mkv", FRAMES - 2)
    result = run(folder)
    assert result.returncode == 0
    assert "depth.mkv" in result.stderr and "missing_depth in 2 of 12 frames" in result.stderr


@pytest.mark.parametrize("made, says", [
    ("tiff of 8 bits", "8 bits"), ("jpeg", "JPEG"), ("cut tiff", "damaged"), ("text", "no depth image"),
    ("tiff of another size", "320 x 240"), ("npy of bool", "b1"), ("fifo", "regular file")])
def test_other_depth_is_refused(recording, images, made, says):
    folder = recording("depth/%d.tiff")
    depth = images[0][0]
    file = folder / "depth/0.tiff"
    if made == "tiff of 8 bits":
        Image.fromarray(depth.astype(np.uint8)).save(file)
    elif made == "jpeg":
        Image.fromarray(depth.astype(np.uint8)).save(file, format="jpeg")
    elif made == "cut tiff":
        Image.fromarray(depth).save(file)
        file.write_bytes(file.read_bytes()[:20000])
    elif made == "text":
        file.write_text("depth")
    elif made == "tiff of another size":
        Image.fromarray(depth[::2, ::2]).save(file)
    elif made == "npy of bool":
        np.save(folder / "depth/0.npy", depth > 0)
        (folder / "depth/0.npy").rename(file)
    else:
        subprocess.run(["mkfifo", file], check=True)
    result = run(folder)
    assert result.returncode == 2
    assert "0.tiff" in result.stderr and says in result.stderr


@pytest.mark.parametrize("made, says", [("missing", "cannot be read"), ("text", "no video"),
                                        ("8 bits", "16-bit grey"), ("other size", "320 x 240")])
def test_other_videos_are_refused(recording, made, says):
    folder = recording("depth.mkv")
    file = folder / "depth.mkv"
    if made == "text":
        file.write_text("depth")
    elif made == "8 bits":
        ffmpeg("-i", SHIPPED / "color/%d.png", "-c:v", "ffv1", file)
    elif made == "other size":
        ffmpeg("-i", SHIPPED / "depth/%d.png", "-vf", "scale=320:240", "-c:v", "ffv1", "-pix_fmt", "gray16le",
               file)
    result = run(folder)
    assert result.returncode == 2
    assert "depth.mkv" in result.stderr and says in result.stderr


def test_ffmpeg_is_needed_for_videos_alone(recording, monkeypatch):
    folder = recording("depth.mkv")
    lossless_depth(folder / "depth.mkv")
    monkeypatch.setenv("PATH", str(folder))
    result = run(folder)
    assert result.returncode == 2 and "ffprobe" in result.stderr


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
    result = run(folder)
    assert result.returncode == 2 and "depth_pose.csv" in result.stderr


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)


@pytest.fixture
def folder(tmp_path):
    """The shipped recording's files without what says how they belong together."""
    folder = tmp_path / "mine"
    shutil.copytree(SHIPPED, folder, ignore=shutil.ignore_patterns("truth", "recording.yaml"))
    return folder


def test_init_finds_what_a_recording_has(folder):
    result = program("init", folder)
    assert result.returncode == 0, result.stderr
    assert "penumbra run" in result.stdout and "parent" in result.stdout
    made, shipped = penumbra.Recording.open(folder), penumbra.Recording.open(SHIPPED)
    assert made.camera.parent == shipped.camera.parent
    for ours, theirs in zip(penumbra.open_input(folder, color=True), penumbra.open_input(SHIPPED, color=True),
                            strict=True):
        np.testing.assert_array_equal(ours.frame.depth, theirs.frame.depth)
        np.testing.assert_array_equal(ours.color, theirs.color)
        assert ours.frame.stamp == theirs.frame.stamp
    again = program("init", folder)
    assert again.returncode == 2 and "--force" in again.stderr
    assert program("init", folder, "--force").returncode == 0


def test_init_names_a_detectors_file(folder):
    (folder / "targets.yaml").unlink()
    box = {"image_id": 0, "category_id": 39, "bbox": [460, 172, 38, 98], "score": 0.9}
    (folder / "results.json").write_text(json.dumps([box]))
    (folder / "notes.json").write_text('{"taken": "by hand"}')
    assert program("init", folder).returncode == 0
    assert 'targets: "results.json"' in (folder / "recording.yaml").read_text()


def test_init_says_what_is_missing(folder):
    (folder / "camera_pose.csv").unlink()
    (folder / "joint_states.csv").write_text("frame,elbow\n0,1\n")
    result = program("init", folder)
    assert result.returncode == 0
    assert "calibrate" in result.stdout.splitlines()[-1] and "--search" in result.stdout
    assert "joints: " in result.stdout and "pose: " in result.stdout
    assert "# pose: " in (folder / "recording.yaml").read_text()


def test_init_needs_one_robot_and_images(folder):
    urdf = folder / "arm_description/arm.urdf"
    shutil.copy(urdf, folder / "other.urdf")
    result = program("init", folder)
    assert result.returncode == 2 and "--robot" in result.stderr
    assert program("init", folder, "--robot", urdf).returncode == 0
    (folder / "recording.yaml").unlink()
    shutil.rmtree(folder / "depth")
    shutil.rmtree(folder / "color")
    result = program("init", folder)
    assert result.returncode == 2 and "images" in result.stderr
    assert not (folder / "recording.yaml").exists()


def test_an_unknown_command_names_near_ones():
    result = program("calibrat")
    assert result.returncode == 2 and "no such command" in result.stderr and "calibrate?" in result.stderr
