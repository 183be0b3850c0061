# SPDX-License-Identifier: Apache-2.0
"""What planned motions will hide: as the command says it, and wrong arguments."""

import json

import numpy as np
import pytest

import penumbra
from conftest import refuses, ROOT, run, SHIPPED

MOTION = ROOT / "examples" / "look_ahead" / "sweep_left.csv"


class Cell:
    def __init__(self):
        self.given = penumbra.open(SHIPPED)
        self.frame = self.given[0]
        self.start = self.frame.pose
        self.camera = penumbra.ForecastCamera(
            "cell", self.given.camera, rule=self.given.config.rule)
        self.lid = penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], frame=""), depth_margin=0.05)
        rows = MOTION.read_text().splitlines()
        self.joints = rows[0].split(",")[1:]
        self.points = np.array([[float(x) for x in row.split(",")] for row in rows[1:]])

    def ahead(self, targets=None, **config):
        return penumbra.LookAhead(self.given.robot, [self.camera], targets or [self.lid],
                                  self.start, penumbra.LookAheadConfig(**config))

    def motion(self):
        return penumbra.Trajectory(self.given.robot, self.joints, self.points[:, 0], self.points[:, 1:], self.start)

    def still(self, times):
        return penumbra.Trajectory(self.given.robot, self.joints, times, self.points[[0, 0], 1:], self.start)


@pytest.fixture(scope="module")
def cell():
    return Cell()


def test_it_says_what_the_command_says(cell, tmp_path):
    run("look-ahead", SHIPPED, "--trajectory", MOTION, "-o", tmp_path)
    (motion,) = json.loads((tmp_path / "look_ahead.json").read_text())["motions"]
    (told,) = [target for target in motion["targets"] if target["name"] == "lid"]
    (forecast,) = cell.ahead().along(cell.motion())
    expected = told["any_camera"]["intervals"]
    assert [each.verdict.value for each in forecast.any.intervals] == [each["verdict"] for each in expected]
    for got, wanted in zip(forecast.any.intervals, expected):
        assert got.by == (wanted["by"] or "")
        np.testing.assert_allclose([got.begin, got.end, got.hidden],
                                   [wanted["begin_s"], wanted["end_s"], wanted["hidden"]], atol=1e-3)
    assert forecast.any.hidden_at is not None and forecast.name == "lid"


def test_visibility_is_that_along_the_motion(cell):
    ahead = cell.ahead()
    motion = cell.motion()
    (forecast,) = ahead.along(motion)
    camera = forecast.cameras[0]
    hidden, clearance = ahead.visibility(motion.at(camera.times))
    assert hidden.shape == clearance.shape == (len(camera.times), 1)
    np.testing.assert_allclose(hidden[:, 0], camera.hidden, atol=1e-6)
    np.testing.assert_allclose(clearance[:, 0], camera.clearance, atol=1e-4)
    assert 0 < hidden.mean() < 1 and len(camera.verdicts) == len(camera.times)
    without, none = cell.ahead(clearance=0).visibility(motion.at(camera.times))
    np.testing.assert_array_equal(without, hidden)
    assert np.isnan(none).all()


def test_a_target_moves_with_its_velocity(cell):
    away = penumbra.ForecastTarget(cell.lid, velocity=[0, 3.0, 0])
    (forecast,) = cell.ahead([away]).along(cell.still([0, 2]))
    assert forecast.any.intervals[-1].verdict is penumbra.Verdict.out_of_view


def test_reports_of_frames_have_forecasts_of_their_plan(cell):
    session = penumbra.Session(cell.given.robot, cell.given.camera, cell.given.config)
    frame = cell.frame.replace(targets=[cell.lid])
    assert session.process(frame).targets[0].forecast == ()
    motion = cell.motion()
    told = session.process(frame.replace(plan=motion)).targets[0].forecast
    (expected,) = cell.ahead(clearance=0, step=0.05).along(motion)
    assert told[0].begin == 0 and told[-1].end == pytest.approx(2.0)  # it looks 2 s ahead
    hidden = [each for each in told if each.verdict is penumbra.Verdict.hidden]
    assert hidden[0].begin == pytest.approx(expected.any.hidden_at, abs=0.02)
    off = frame.pose.positions.copy()
    off[1] += 0.5
    (none,) = session.process(frame.replace(plan=motion, pose=off)).targets[0].forecast
    assert none.verdict is penumbra.Verdict.unknown and "not on the planned motion" in none.reason


def test_a_trajectory_has_its_faults(cell):
    motion = cell.motion()
    assert motion.duration == 3 and motion.notes == ()
    assert abs(motion.jump[1]) < 1e-9
    np.testing.assert_allclose(motion.at([1.5])[0][:3], cell.points[1, 1:])
    refuses("rise", lambda: cell.still([0, 0]))
    refuses("no_joint", lambda: penumbra.Trajectory(cell.given.robot, ["no_joint"], [0], [[0]], cell.start))
    refuses("positions", lambda: penumbra.Trajectory(cell.given.robot, cell.joints, [0, 1], [[0, 0]], cell.start),
            ValueError)
    refuses("joint positions", lambda: penumbra.LookAhead(cell.given.robot, [cell.camera], [cell.lid],
                                                          penumbra.RobotPose()))
    refuses("positions", lambda: cell.ahead().visibility([[0.0]]), ValueError)
