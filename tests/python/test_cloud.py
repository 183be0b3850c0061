# SPDX-License-Identifier: Apache-2.0
"""Clouds against a box by hand."""

import numpy as np

import penumbra
from conftest import refuses
from test_stages import box_mesh, pose

L = penumbra.Label


def box_labeller(**rule):
    return penumbra.CloudLabeller([penumbra.Body("box", [box_mesh(0.2)])], penumbra.CloudRule(**rule))


def test_points_before_on_and_behind_a_box():
    points = np.array([[0, 0, 0.5, 7], [0, 0, 0.91, 7], [0, 0, 3, 7], [0, 2, 1, 7], [np.nan] * 4], np.float32)
    found = box_labeller().label(points, [pose(0, 0, 1)], origin=[0, 0, 0])
    assert found.labels.tolist() == [L.front, L.occluded, L.beyond, L.clear, L.unknown]
    assert found.links.tolist() == [1, 1, 1, 0, 0] and found.enclosing is None


def test_a_box_that_moves_during_the_scan():
    points = np.array([[0, 0, 0.91], [0, 0, 1.41], [0, 0, 0.91], [0, 0, 1.41]], np.float32)
    parts = np.array([0, 0, 1, 1], np.uint16)
    labeller = penumbra.CloudLabeller([penumbra.Body("box", [box_mesh(0.2)])], threads=2)
    poses = [pose(0, 0, 1), pose(0, 0, 1.5)]
    found = labeller.label(points, poses, origin=[0, 0, 0], parts=parts)
    assert found.labels.tolist() == [L.occluded, L.beyond, L.front, L.occluded]
    refuses("uint16", lambda: labeller.label(points, poses, origin=[0, 0, 0], parts=[0, 0, 1, 1]), TypeError)
    few = parts[:3]
    refuses("3 parts for 4 points", lambda: labeller.label(points, poses, origin=[0, 0, 0], parts=few), ValueError)
    refuses("of one instant", lambda: labeller.label(points, poses, parts=parts), ValueError)
    assert penumbra.CloudRule.for_sensor("hokuyo").tolerance.a > 0.03
    refuses("lidar_2cm", lambda: penumbra.CloudRule.for_sensor("eyes"))


def test_points_without_rays_and_a_sensor_in_the_box():
    points = np.array([[0, 0, 1], [0, 0, 0.88], [0, 0, 0.8]], np.float32)
    labeller = box_labeller(tolerance=penumbra.Tolerance(a=0.05, b=0, c=0))
    assert labeller.label(points, [pose(0, 0, 1)]).labels.tolist() == [L.occluded, L.occluded, L.clear]
    reverse = labeller.label(points[::-1], [pose(0, 0, 1)]).labels.tolist()
    assert reverse == [L.clear, L.occluded, L.occluded]
    assert labeller.label(points[:0], [pose(0, 0, 1)]).labels.shape == (0,)
    inside = labeller.label(points, [pose(0, 0, 1)], origin=[0, 0, 1])
    assert inside.enclosing == 0 and set(inside.labels) == {L.unknown}


def test_other_arrays_poses_and_rules_are_refused():
    for points, fault in (([[0, 0, 1]], TypeError), (np.zeros((2, 3)), TypeError),
                          (np.zeros((2, 2), np.float32), ValueError), (np.zeros(3, np.float32), ValueError),
                          (np.zeros((3, 2), np.float32).T, ValueError)):
        refuses("points: expected numpy.ndarray of float32 with shape",
                lambda: box_labeller().label(points, [pose(0, 0, 1)], origin=[0, 0, 0]), fault)
    points = np.zeros((1, 3), np.float32)
    refuses("2 poses for 1 bodies", lambda: box_labeller().label(points, [pose(0, 0, 1)] * 2), ValueError)
    refuses("beam 1: expected a number from 0 to 0.01", lambda: box_labeller(beam=1))
