# SPDX-License-Identifier: Apache-2.0
"""The shipped arm picks a part up and puts it down: python3 pick_and_place.py

attach_target() when the gripper closes, nothing when it opens. The images do not show this part, so
the camera is one that measures no depth.
"""
import pathlib
from typing import List

import numpy as np

import penumbra

CLOSES, OPENS = 3, 8  # frames
given = penumbra.open(pathlib.Path(__file__).parent.parent / "arm_over_table")
session = penumbra.Session(given.robot, given.camera, given.config.replace(has_depth=False))
gripper = given.robot.find_link("gripper")
T_base_part = np.eye(4)
T_base_part[:3, 3] = 0.634, -0.041, 0.22  # metres: where a detector found it

attached: List[penumbra.AttachedBody] = []
for i, frame in enumerate(given):
    box = penumbra.BoxTarget(T_base_part, [0.06, 0.06, 0.12], frame="")
    part = penumbra.Target("part", box, handling=penumbra.PoseTrackerConfig())
    pose = frame.pose.replace(attached=attached)
    report = session.process(frame.replace(depth=None, pose=pose, targets=[part]))
    found = report.targets[0]
    assert found.handled and found.handled.position is not None
    print(i, found.verdict.value, found.handled.position.round(3), found.reason)
    if i == CLOSES:
        attached = [session.attach_target(part, "gripper")]
    if i == OPENS:
        links = given.robot.forward_kinematics(frame.pose.positions)
        T_base_part = links[gripper] @ attached.pop().T_link_body
