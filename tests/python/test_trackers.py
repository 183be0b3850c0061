# SPDX-License-Identifier: Apache-2.0
"""Targets and trackers: what goes in comes out, and hidden targets are carried on."""

import numpy as np
import pytest

import penumbra
from conftest import refuses
from penumbra import Outcome, Source, Verdict
from test_stages import pose

SECOND = 1_000_000_000


def test_a_hidden_pose_goes_on_along_its_direction():
    tracker = penumbra.PoseTracker(penumbra.PoseTrackerConfig(
        motion=penumbra.Motion.along_direction, direction=[1, 0, 0]))
    for i in range(11):
        assert tracker.update(i * SECOND // 10, pose(0.02 * i, 0, 0), Verdict.visible) is Outcome.accepted
    refused = tracker.update(int(1.1 * SECOND), pose(5.0, 0, 0), Verdict.hidden)
    assert refused is Outcome.refused_verdict
    predicted = tracker.at(int(1.5 * SECOND))
    assert predicted.source is Source.predicted and predicted.age == pytest.approx(0.5)
    assert predicted.pose[0, 3] == pytest.approx(0.3, abs=0.01)  # 0.2 m/s
    assert predicted.twist[0] == pytest.approx(0.2, abs=0.02)
    assert predicted.covariance.shape == (6, 6)
    assert tracker.at(9 * SECOND).source is Source.lost
    tracker.reset()
    assert tracker.at(SECOND).age == float("inf")


def test_a_hidden_point_is_held():
    tracker = penumbra.PointTracker()
    assert tracker.update(0, [1, 2, 3], Verdict.visible, covariance=1e-4 * np.eye(3)) is Outcome.accepted
    held = tracker.at(SECOND)
    assert held.source is Source.held and held.position.tolist() == [1, 2, 3]
    assert tracker.update(2 * SECOND, [np.nan, 0, 0], Verdict.visible) is Outcome.refused_invalid


def test_every_kind_of_region_is_judged(opened):
    mask = np.zeros((480, 640), bool)
    mask[20:60, 10:40] = True
    rendered = np.where(mask, np.float32(1.0), np.float32(0))
    runs = [10 * 480 + 20] + 29 * [40, 440] + [40]
    runs.append(480 * 640 - sum(runs))
    regions = [penumbra.PixelBox(10, 20, 30, 40),
               penumbra.PixelPolygon([[9.5, 19.5], [39.5, 19.5], [39.5, 59.5], [9.5, 59.5]]),
               penumbra.PixelMask(mask), penumbra.PixelMask(mask.astype(np.uint8)),
               penumbra.RunLengthMask(640, 480, runs), penumbra.RenderedRegion(rendered)]
    targets = [penumbra.Target(str(i), penumbra.RegionTarget(region)) for i, region in enumerate(regions)]
    report = opened.session.process(opened.frames[0].replace(targets=targets))
    assert [t.judgement.covered for t in report.targets] == 6 * [1200]
    for region in regions:
        penumbra.check_region(region, 640, 480)
    refuses("", lambda: penumbra.check_region(regions[2], 320, 240))


def test_coco_annotations_are_masks(opened):
    report = opened.session.process(opened.frames[0])
    coco = report.coco_annotation()
    height, width = coco["segmentation"]["size"]
    text = coco["segmentation"]["counts"]
    for counts in (text, text.encode()):
        mask = penumbra.RunLengthMask(width, height, counts)
        by_columns = np.repeat(np.arange(len(mask.counts)) % 2 == 1, mask.counts)
        assert np.array_equal(by_columns.reshape(width, height).T, report.robot_mask)


def test_shapes_in_space_and_their_handling(opened):
    cube = penumbra.TriangleMesh(np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]], np.float32),
                                 np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32))
    T = pose(0.52, 0.28, 0.04)
    handling = penumbra.PoseTrackerConfig(motion=penumbra.Motion.still)
    targets = [
        penumbra.Target("box", penumbra.BoxTarget(T, [0.08, 0.08, 0.08], frame="base_link"),
                        depth_margin=0.02, handling=handling),
        penumbra.Target("mesh", penumbra.MeshTarget(cube, T, frame=""), depth_margin=0.02),
        penumbra.Target("point", penumbra.PointTarget([0.42, 0.56, 0.30], frame="base_link"),
                        depth_margin=0.05, handling=penumbra.PointTrackerConfig()),
        penumbra.Target("key", penumbra.KeypointTarget(pixel=[479, 221], score=0.9)),
        penumbra.Target("late", penumbra.KeypointTarget(pixel=[479, 221]), stamp=1),
        penumbra.Target("gone", None),
        penumbra.Target("elsewhere", penumbra.BoxTarget(T, [1, 1, 1], frame="no_link")),
        penumbra.Target("estimated", penumbra.PointTarget([0.42, 0.56, 0.30], frame="base_link"),
                        handling=penumbra.PointTrackerConfig(),
                        estimate=penumbra.TargetEstimate(None)),
    ]
    frame = opened.frames[0].replace(targets=targets)
    by_name = {t.name: t for t in opened.session.process(frame).targets}
    assert by_name["box"].verdict is Verdict.visible
    assert by_name["box"].handled.source is Source.measured
    assert np.allclose(by_name["box"].handled.position, T[:3, 3])
    assert by_name["mesh"].judgement.covered > 50
    assert by_name["point"].handled.orientation is None
    assert by_name["late"].verdict is Verdict.unknown and by_name["late"].reason
    assert by_name["gone"].verdict is Verdict.unknown and by_name["gone"].judgement is None
    assert "no_link" in by_name["elsewhere"].reason
    assert by_name["estimated"].estimate is None
    assert by_name["estimated"].handled.source is Source.lost
    for target in targets[:4]:
        target.check()
    opened.session.forget_target("box")
    opened.session.begin_sequence()
