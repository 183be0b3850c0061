# SPDX-License-Identifier: Apache-2.0
"""Several cameras: their frames, and one verdict over them. Several robots as one."""

import shutil

import numpy as np
import pytest
import yaml

import penumbra
from conftest import Opened, refuses, SHIPPED
from test_stages import pose


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


def test_targets_are_fused(folder):
    refuses("left, right", lambda: penumbra.open(folder))
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


def test_robots_are_joined_and_fail_alone():
    opened = Opened(SHIPPED)
    aside = pose(0, 0.6, 0)
    both = penumbra.Robot.join([("a", opened.robot, np.eye(4)), ("b", opened.robot, aside)])
    assert both.links[0] == "world" and both.links[1] == "a/base_link"
    session = penumbra.Session(both, opened.camera.replace(parent="a/base_link"), opened.config)
    frame = opened.frames[0]
    joints = list(frame.pose.positions)
    poses = both.forward_kinematics(joints + joints)
    alone = opened.robot.forward_kinematics(joints)
    assert np.allclose(poses[1 + len(alone):], aside @ alone, atol=1e-12)

    report = session.process(frame.replace(pose=joints + joints))
    assert report.status == penumbra.FrameStatus.ok
    of_b = [i for i, link in enumerate(both.links) if link.startswith("b/")]
    report = session.process(frame.replace(pose=penumbra.RobotPose(
        positions=joints + joints, uncertain_links=of_b, uncertain_reason="stale")))
    assert report.status == penumbra.FrameStatus.missing_link and "b/base_link" in report.message
    refuses("name", lambda: penumbra.Robot.join([("a", opened.robot, np.eye(4)), ("a", opened.robot, aside)]))
