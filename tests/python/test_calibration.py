# SPDX-License-Identifier: Apache-2.0
"""A camera's pose from the frames of the shipped recording, whose true pose is in it."""

import numpy as np

import penumbra
from conftest import refuses, SHIPPED

GIVEN = penumbra.open(SHIPPED)
FRAMES = list(GIVEN)
TRUTH = GIVEN.camera.T_parent_camera
ROUGH = TRUTH.copy()
ROUGH[:3, 3] += [0.05, -0.04, 0.04]


def calibrated(frames, initial, **options):
    camera = GIVEN.camera.replace(T_parent_camera=initial)
    return penumbra.calibrate(frames, camera, GIVEN.robot, **options)


def test_a_rough_guess_ends_at_the_true_pose():
    found = calibrated(FRAMES, ROUGH)
    assert found.is_good and found.faults == ()
    error = np.linalg.norm(found.T_parent_camera[:3, 3] - TRUTH[:3, 3])
    assert error < found.position_error < 0.01
    assert len(found.frames) == len(FRAMES) and all(fit.agreeing > 0.6 for fit in found.frames)
    assert found.covariance.shape == (6, 6)


def test_an_opened_input_is_calibrated_as_on_the_command_line():
    found = penumbra.calibrate(GIVEN, GIVEN.camera, GIVEN.robot)
    by_list = calibrated(FRAMES, TRUTH)
    assert found.is_good and np.array_equal(found.T_parent_camera, by_list.T_parent_camera)
    # As a bag whose tf has the camera, whose own pose is not known.
    by_tf = [frame.replace(pose=frame.pose.replace(T_parent_camera=ROUGH)) for frame in FRAMES]
    found = calibrated(by_tf, None)
    assert found.is_good
    assert np.linalg.norm(found.T_parent_camera[:3, 3] - TRUTH[:3, 3]) < 0.003
    moved = by_tf[:3] + FRAMES[3:4] + [by_tf[4].replace(pose=by_tf[4].pose.replace(T_parent_camera=TRUTH))]
    refuses("frame 4: the camera moves", lambda: calibrated(moved, None))
    refuses("T_parent_camera", lambda: calibrated(FRAMES, None))


def test_faults_are_told():
    wall = [frame.replace(depth=np.full_like(frame.depth, 3000)) for frame in FRAMES]
    found = calibrated(wall, TRUTH)
    assert not found.is_good and "not in view" in found.faults[0]
    refuses("3 frames", lambda: calibrated(FRAMES[:2], TRUTH))
    refuses("masks", lambda: calibrated(FRAMES, TRUTH, masks=[np.zeros((480, 640), np.uint8)]), ValueError)
    jointless = [FRAMES[0], penumbra.Frame(None, None), FRAMES[1]]
    refuses("frame 1: has no joint positions", lambda: calibrated(jointless, TRUTH))
    blind = [FRAMES[0], FRAMES[1].replace(depth=None), FRAMES[2]]
    refuses("frame 1: has no depth image", lambda: calibrated(blind, TRUTH))


def test_masks_alone_are_enough():
    session = penumbra.Session(GIVEN.robot, GIVEN.camera, GIVEN.config)
    masks = [session.process(frame).robot_mask for frame in FRAMES]
    masks[0] = masks[0].astype(np.uint8)
    frames = [frame.replace(depth=None) for frame in FRAMES]
    found = calibrated(frames, ROUGH, masks=masks)
    assert found.is_good
    assert found.depth_offset is None and found.shift_right is None
    assert found.mask_overlap > 0.99
    assert np.linalg.norm(found.T_parent_camera[:3, 3] - TRUTH[:3, 3]) < 0.002
    refuses("frame 0: has no depth image", lambda: calibrated(frames, ROUGH))
    refuses("need depth images", lambda: calibrated(frames, ROUGH, masks=masks, joint_offsets=True))


def test_colour_images_alone_are_enough():
    opened = penumbra.open(SHIPPED, color=True)
    frames = [frame.replace(depth=None) for frame in opened]
    found = calibrated(frames, ROUGH, images=True)
    assert found.is_good
    off = np.linalg.norm(found.T_parent_camera[:3, 3] - TRUTH[:3, 3])
    assert off < min(0.006, found.position_error)
    refuses("need depth images", lambda: calibrated(frames, ROUGH, images=True, joint_offsets=True))
    refuses("color=True", lambda: calibrated(FRAMES, ROUGH, images=True))
    masks = [np.zeros((480, 640), np.uint8)] * len(frames)
    refuses("masks are given too", lambda: calibrated(frames, ROUGH, images=True, masks=masks), ValueError)


def test_the_time_between_images_and_joints():
    late = 0.03  # seconds: the stamps of the images
    stamps = [frame.stamp for frame in FRAMES]
    joints = np.array([frame.pose.positions for frame in FRAMES])

    def posed(image, stamp):
        return penumbra.Frame(image, [np.interp(stamp, stamps, one) for one in joints.T], stamp=stamp)

    motion = [posed(None, t) for t in range(stamps[0], stamps[-1] + 1, 20_000_000)]
    images = [posed(frame.depth, frame.stamp + round(1e9 * late)) for frame in FRAMES[2:-2]]
    found = calibrated(images, TRUTH, motion=motion)
    error = abs(found.time_offset.value + late)
    assert found.is_good and error < 0.003
    assert calibrated(images[:3], TRUTH).time_offset is None
    unstamped = [motion[0].replace(stamp=None)]
    refuses(r"motion\[0\]: needs a stamp", lambda: calibrated(images, TRUTH, motion=unstamped), ValueError)
    refuses("poses before and after", lambda: calibrated(FRAMES, TRUTH, motion=motion))
