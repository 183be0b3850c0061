# SPDX-License-Identifier: Apache-2.0
"""Several robots as one."""

import numpy as np

import penumbra
from conftest import Opened, refuses, SHIPPED
from test_stages import pose


def test_robots_are_joined_and_fail_alone():
    opened = Opened(SHIPPED)
    aside = pose(0, 0.6, 0)
    both = penumbra.Robot.join([("a", opened.robot, np.eye(4)), ("b", opened.robot, aside)])
    assert both.links[0] == "world" and both.links[1] == "a/base_link"
    config = opened.config.replace(camera_parent="a/base_link")
    session = penumbra.Session(both, opened.camera, config)
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
