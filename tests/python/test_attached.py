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


def test_one_that_cannot_be_drawn_is_a_missing_link(opened):
    part = penumbra.AttachedBody("part", "elbow", box_mesh(0.1), np.eye(4))
    frame = opened.frames[0]
    report = opened.session.process(frame.replace(pose=frame.pose.replace(attached=[part])))
    assert report.status == penumbra.FrameStatus.missing_link
    assert report.missing_links == ("part",) and "'elbow'" in report.message
    assert not report.filtered_depth().any()


def test_recordings_name_them_by_frames(tmp_path):
    folder = tmp_path / "in"
    shutil.copytree(SHIPPED, folder)
    with open(folder / "recording.yaml", "a") as file:
        file.write("attached:\n  - {name: part, link: gripper, box: [0.1, 0.1, 0.1], frames: [3, 5]}\n")
    found = [[body.name for body in frame.pose.attached] for frame in penumbra.open(folder)]
    assert found == [["part"] if i in (3, 4) else [] for i in range(12)]


def test_a_target_that_is_attached_is_held_and_goes_with_the_link(opened):
    frame = opened.frames[0]
    robot = opened.session.robot
    links = robot.forward_kinematics(frame.pose.positions)
    in_gripper = pose(0, 0, 0.15)
    box = penumbra.BoxTarget(in_gripper, [0.1, 0.1, 0.1], frame="gripper")
    target = penumbra.Target("part", box, handling=penumbra.PoseTrackerConfig())
    session = opened.session
    refuses("target 'part' was not in the last frame", lambda: session.attach_target(target, "gripper"))
    unseen = penumbra.Target("part", box)
    first = session.process(frame.replace(stamp=0, targets=[unseen]))
    assert first.targets[0].verdict != penumbra.Verdict.held
    body = session.attach_target(unseen, "forearm")
    assert (body.name, body.link) == ("part", "forearm")
    forearm, gripper = (links[robot.find_link(name)] for name in ("forearm", "gripper"))
    assert np.allclose(body.T_link_body, np.linalg.inv(forearm) @ gripper @ in_gripper)
    session.forget_target("part")
    turned = frame.pose.positions + 0.2
    report = session.process(frame.replace(
        stamp=10**8, targets=[target], pose=penumbra.RobotPose(positions=turned, attached=[body])))
    held = report.targets[0]
    assert held.verdict == penumbra.Verdict.held and held.reason == "it is attached to link 'forearm'"
    assert held.judgement is None and held.estimate == penumbra.Outcome.refused_verdict
    place = robot.forward_kinematics(turned)[robot.find_link("forearm")] @ body.T_link_body
    assert np.allclose(held.handled.position, place[:3, 3])
    assert held.handled.source == penumbra.Source.predicted and held.handled.age == 0
    refuses("'elbow' is not a link", lambda: session.attach_target(target, "elbow"))
