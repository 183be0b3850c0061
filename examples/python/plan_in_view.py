# SPDX-License-Identifier: Apache-2.0
"""A planner that keeps a target in view: python3 plan_in_view.py

The cross-entropy method (Rubinstein, 1999) moves two points of a path in joint space. What a path
costs is its length, plus `weight` times the target's mean hidden share along it.
"""

import pathlib
from typing import Any, Tuple

import numpy as np
from numpy.typing import NDArray

import penumbra

RECORDING = pathlib.Path(__file__).parent.parent / "arm_over_table"
JOINTS = ["shoulder_pan", "shoulder_lift", "elbow"]
START, GOAL = np.array([-0.7, 0.5, 1.25]), np.array([1.05, 0.55, 1.4])  # rad
STEPS, PATHS, BEST, ROUNDS = 40, 64, 8, 12
Array = NDArray[Any]


class Planner:
    def __init__(self) -> None:
        given = penumbra.open(RECORDING)
        camera = penumbra.ForecastCamera("cell", given.camera)
        lid = penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], radius=0.03, frame=""))
        start = given[0].pose
        config = penumbra.LookAheadConfig(clearance=0, threads=2)
        self.ahead = penumbra.LookAhead(given.robot, [camera], [lid], start, config)
        self.rest = start.positions[None]
        self.columns = [given.robot.find_variable(joint) for joint in JOINTS]

    def positions(self, between: Array) -> Array:
        """(P, STEPS, J) on straight lines through the points (P, 2, J) between start and goal."""
        ends = [np.broadcast_to(end, (len(between), 1, 3)) for end in (START, GOAL)]
        points = np.concatenate([ends[0], between, ends[1]], axis=1)
        at = np.linspace(0, 3, STEPS)
        first = np.minimum(at.astype(int), 2)
        part = (at - first)[:, None]
        path: Array = (1 - part) * points[:, first] + part * points[:, first + 1]
        return path

    def cost(self, between: Array) -> Tuple[Array, Array]:
        """Lengths in rad, and mean hidden shares."""
        path = self.positions(between)
        whole = self.rest.repeat(len(path) * STEPS, axis=0)
        whole[:, self.columns] = path.reshape(-1, 3)
        hidden, _ = self.ahead.visibility(whole)
        return (np.linalg.norm(np.diff(path, axis=1), axis=2).sum(axis=1),
                hidden.reshape(-1, STEPS).mean(axis=1))

    def plan(self, weight: float, seed: int = 1) -> Tuple[float, float]:
        random = np.random.default_rng(seed)
        mean = np.linspace(START, GOAL, 4)[1:3]
        spread = np.full(mean.shape, 0.5)
        for _ in range(ROUNDS):
            tried = np.concatenate([mean[None], random.normal(mean, spread, (PATHS, *mean.shape))])
            length, hidden = self.cost(tried)
            best = tried[np.argsort(length + weight * hidden)[:BEST]]
            mean, spread = best[0], best.std(axis=0) + 1e-3
        length, hidden = self.cost(mean[None])
        return float(length[0]), float(hidden[0])


if __name__ == "__main__":
    planner = Planner()
    for weight in (0.0, 1.0, 10.0):
        length, hidden = planner.plan(weight)
        print(f"weight {weight:4.1f}: path {length:.2f} rad, target seen {100 * (1 - hidden):.0f} %")
