# SPDX-License-Identifier: Apache-2.0
"""Bodies that the robot's links carry."""

import shutil

import numpy as np

import penumbra
from conftest import refuses, SHIPPED
from test_stages import box_mesh, pose


def test_a_body_in_the_gripper_hides_and_is_blamed(opened):
    frame = opened.frames[0]
    part = penumbra.AttachedBody("part", "gripper", box_mesh(0.12), pose(0, 0, 0.15))
    target = penumbra.Target("all", penumbra.RegionTarget(penumbra.PixelBox(0, 0, 640, 480)))
    without = opened.session.process(frame)
    robot = without.pixels.robot
    assert without.attached == ()
    report = opened.session.process(frame.replace(pose=frame.pose.replace(attached=[part]), targets=[target]))
    assert report.attached == ("part",) and report.links[-1] == "part"
    of_part = np.count_nonzero(report.link_image == len(report.links))
    assert of_part > 1000 and report.pixels.robot > robot + of_part / 2
    assert "part" in [blame.link for blame in report.targets[0].judgement.blame]
    assert np.isfinite(report.points(frame="base_link").points).all()
    refuses("no link 'part'", lambda: report.points(frame="part"))
    assert opened.session.process(frame).pixels.robot == robot


def test_recordings_name_them_by_frames(tmp_path):
    folder = tmp_path / "in"
    shutil.copytree(SHIPPED, folder)
    with open(folder / "recording.yaml", "a") as file:
        file.write("attached:\n  - {name: part, link: gripper, box: [0.1, 0.1, 0.1], frames: [3, 5]}\n")
    found = [[body.name for body in frame.pose.attached] for frame in penumbra.open(folder)]
    assert found == [["part"] if i in (3, 4) else [] for i in range(12)]


def test_targets_that_cannot_be_attached_are_refused(opened):
    """examples/python/pick_and_place.py attaches one."""
    target = penumbra.Target("part", penumbra.BoxTarget(pose(0, 0, 0.15), [0.1, 0.1, 0.1], frame="gripper"))
    session = opened.session
    refuses("target 'part' was not in the last frame", lambda: session.attach_target(target, "gripper"))
    assert session.process(opened.frames[0].replace(targets=[target])).targets[0].verdict != penumbra.Verdict.held
    refuses("'elbow' is not a link", lambda: session.attach_target(target, "elbow"))
    assert session.attach_target(target, "forearm").link == "forearm"
