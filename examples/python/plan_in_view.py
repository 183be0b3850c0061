# SPDX-License-Identifier: Apache-2.0
"""A planner that keeps a target in view: python3 plan_in_view.py

Tries 300 paths that pass a random point in joint space. A path costs its length plus `weight` times
the target's mean hidden share along it.
"""
import pathlib

import numpy as np

import penumbra

JOINTS = ["shoulder_pan", "shoulder_lift", "elbow"]
START, GOAL = np.array([-0.7, 0.5, 1.25]), np.array([1.05, 0.55, 1.4])  # rad
PATHS, STEPS = 300, 20

given = penumbra.open(pathlib.Path(__file__).parent.parent / "arm_over_table")
camera = penumbra.ForecastCamera("cell", given.camera)
lid = penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], radius=0.03, frame=""))
start = given[0].pose
ahead = penumbra.LookAhead(given.robot, [camera], [lid], start,
                           penumbra.LookAheadConfig(clearance=0, threads=2))

middle = (START + GOAL) / 2
between = np.random.default_rng(1).normal(middle, 0.4, (PATHS, 3))
between[0] = middle  # the shortest path
at = np.linspace(0, 1, STEPS // 2)[:, None, None]
path = np.concatenate([START + at * (between - START), between + at * (GOAL - between)])
length = np.linalg.norm(between - START, axis=1) + np.linalg.norm(GOAL - between, axis=1)

positions = np.tile(start.positions, (STEPS * PATHS, 1))
positions[:, [given.robot.find_variable(joint) for joint in JOINTS]] = path.reshape(-1, 3)
shares, _ = ahead.visibility(positions)  # nan: unknown, or out of view
hidden = np.nan_to_num(shares, nan=1).reshape(STEPS, PATHS).mean(axis=0)
for weight in (0, 1, 10):
    best = np.argmin(length + weight * hidden)
    print(f"weight {weight:2}: path {length[best]:.2f} rad, target seen {100 * (1 - hidden[best]):.0f} %")
