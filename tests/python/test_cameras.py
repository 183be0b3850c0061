# SPDX-License-Identifier: Apache-2.0
"""Several cameras: their frames, and one verdict over them."""

import shutil

import numpy as np
import pytest
import yaml

import penumbra
from conftest import refuses, SHIPPED


@pytest.fixture
def folder(tmp_path):
    """The shipped recording as that of two cameras at one place."""
    folder = tmp_path / "in"
    shutil.copytree(SHIPPED, folder)
    given = yaml.safe_load((folder / "recording.yaml").read_text())
    camera = {**given.pop("camera"), "depth": given["frames"].pop("depth")}
    del given["frames"]["color"]
    given["cameras"] = {"left": camera, "right": {**camera}}
    (folder / "recording.yaml").write_text(yaml.safe_dump(given))
    return folder


def test_a_recording_of_several_cameras_wants_a_name(folder):
    refuses("left, right", lambda: penumbra.open(folder))
    assert len(penumbra.open(folder, camera="right")) == 12


def test_targets_are_fused(folder):
    given = [penumbra.open(folder, camera=name) for name in ("left", "right")]
    sessions = [penumbra.Session(one.robot, one.camera, one.config) for one in given]
    fusion = penumbra.TargetFusion([
        penumbra.ViewCamera(name, one.camera.intrinsics, one.config.rule.tolerance)
        for name, one in zip(("left", "right"), given)])
    box = penumbra.PixelBox(460, 172, 38, 98)
    target = penumbra.Target("cylinder", penumbra.RegionTarget(box, expected_depth=1.87), depth_margin=0.10)
    frames = [one[0] for one in given]
    reports = [sessions[0].process(frames[0].replace(targets=[target])),
               sessions[1].process(frames[1].replace(targets=[target]))]
    for i, report in enumerate(reports):
        fusion.add(i, report)
    (fused,) = fusion.fused()
    assert fused.name == "cylinder" and fused.verdict == reports[0].targets[0].verdict
    assert fused.best == 0 and fused.contradiction is None
    assert [view.camera for view in fused.views] == [0, 1]
    # Two equal measurements: the same point, half the covariance.
    np.testing.assert_allclose(fused.point, fused.views[0].point)
    np.testing.assert_allclose(fused.covariance, fused.views[0].covariance / 2)
    refuses("no camera 2", lambda: fusion.add(2, reports[0]))
