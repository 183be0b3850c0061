# SPDX-License-Identifier: Apache-2.0
"""Python and the command line say the same."""

import json
import shutil

import numpy as np
import pytest

import penumbra
from conftest import DATA, SHIPPED, Opened, read_png, refuses, run, run_python, skip_without_data

BAG = DATA / "xarm7_realsense" / "xarm7.mcap"
RECORDINGS = [SHIPPED, DATA / "xarm7_realsense", BAG]
PACKAGES = {"xarm_description": DATA / "robots" / "xarm7" / "xarm_description"}
BAG_OPTIONS = penumbra.BagOptions(packages=PACKAGES)


@pytest.mark.parametrize("folder", RECORDINGS, ids=["shipped", "real", "bag"])
def test_images_are_identical(folder, tmp_path):
    if folder != SHIPPED:
        skip_without_data()
    packages = [f"--package={name}={path}" for name, path in PACKAGES.items()]
    run("run", folder, "-o", tmp_path, "--save", "vdi,labels,links", "--targets", "none",
        *(packages if folder == BAG else []))
    told = json.loads((tmp_path / "report.json").read_text())
    assert len(told["frames"]) >= 10
    given = penumbra.open(folder, bag=BAG_OPTIONS if folder == BAG else None)
    session = penumbra.Session(given.robot, given.camera, given.config)
    for frame, recorded in zip(told["frames"], given, strict=True):
        report = session.process(recorded)
        name = f"{frame['index']:06d}"
        assert np.array_equal(np.load(tmp_path / "vdi" / f"{name}.npy"), report.virtual_depth)
        assert np.array_equal(read_png(tmp_path / "labels" / f"{name}.png"), report.labels)
        assert np.array_equal(read_png(tmp_path / "links" / f"{name}.png"), report.link_image)
        pixels = {key: getattr(report.pixels, key) for key in frame["pixels"]}
        assert pixels == frame["pixels"] and np.count_nonzero(report.labels)
        assert (report.index, report.stamp) == (frame["index"], frame["stamp_ns"])
        assert report.status.value == frame["status"]


def test_targets_are_judged_alike(tmp_path):
    run("run", SHIPPED, "-o", tmp_path)
    told = json.loads((tmp_path / "report.json").read_text())["frames"]
    opened = Opened(SHIPPED)
    file = opened.targets()
    verdicts = set()
    for frame, expected in zip(opened.frames, told, strict=True):
        report = opened.session.process(frame.replace(targets=file.of_frame(frame.index)))
        for target, of in zip(report.targets, expected["targets"], strict=True):
            judged, is_in = target.judgement, target.judgement.inside > 0
            assert [of[key] for key in ("name", "verdict", "covered", "inside")] == [
                target.name, target.verdict.value, judged.covered, judged.inside]
            for key in ("occluded", "front", "clear", "unknown"):
                assert of[f"{key}_fraction"] == (pytest.approx(getattr(judged, key)) if is_in else None)
            assert [blame["link"] for blame in of["blame"]] == [blame.link for blame in judged.blame]
            assert of["point"] == (None if target.point is None else pytest.approx(target.point.tolist()))
            if of["handled"] is not None:
                assert of["handled"]["source"] == target.handled.source.value
            verdicts.add(target.verdict)
    assert len(verdicts) >= 3


def test_an_input_is_what_run_takes():
    given = penumbra.open(SHIPPED, color=True, frames=(2, 5))
    frames = list(given)
    assert [frame.index for frame in frames] == [2, 3, 4]
    assert frames[0].color.shape == (480, 640, 3) and given.targets.name == "targets.yaml"
    assert iter(given).size == 3 and given.messages == ()
    shown = given.camera.intrinsics.width, given.camera.intrinsics.height
    assert shown == (640, 480) and given.camera.parent == "base_link"


def test_a_bag_tells_what_is_taken_of_it():
    skip_without_data()
    given = penumbra.open(BAG, color=True, bag=BAG_OPTIONS)
    assert any(line.startswith("depth: /camera/") for line in given.messages)
    frames = iter(given)
    first = next(frames)
    assert first.depth.shape == first.color.shape[:2] == (720, 1280)
    assert first.pose.age is not None and frames.notes == ()
    colors = first.color.copy()
    assert len(list(frames)) > 3 and np.array_equal(first.color, colors), "it is not overwritten"


def test_python_m_penumbra_is_the_command_line(tmp_path):
    for status, *arguments in ((0, "--version"), (0, "--help"), (0, "run", "--help"), (2, "inspect", "nothing.urdf"),
                               (2, "run"), (2, "doctor", "--nonsense"), (2, "run", "nowhere", "-o", tmp_path)):
        expected = run(*arguments, status=status)
        told = run_python("-m", "penumbra", *arguments, status=status)
        assert (told.stdout, told.stderr) == (expected.stdout, expected.stderr)


def test_an_input_without_targets_says_so(tmp_path):
    folder = tmp_path / "recording"
    shutil.copytree(SHIPPED, folder)
    yaml = (folder / "recording.yaml").read_text()
    (folder / "recording.yaml").write_text(yaml.replace("targets: targets.yaml", ""))
    given = penumbra.open(folder)
    refuses("give the file", given.open_targets)
    assert len(given.open_targets(SHIPPED / "targets.yaml")) == 4
