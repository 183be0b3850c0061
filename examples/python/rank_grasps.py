# SPDX-License-Identifier: Apache-2.0
"""Which of five ways to a grasp keeps the targets in view: python3 rank_grasps.py

The arm of the shipped recording turns to the side. The ways pass other points, in 3 s each.
"""
import pathlib
from typing import Dict, List

import numpy as np

import penumbra

JOINTS = ["shoulder_pan", "shoulder_lift", "elbow"]
START, GRASP = [-0.7, 0.5, 1.25], [1.05, 0.55, 1.4]  # rad
WAYS: Dict[str, List[List[float]]] = {
    "straight": [], "over the top": [[-0.7, -0.4, 0.9], [1.05, -0.4, 0.9]],
    "arm folded": [[-0.7, -0.2, 2.2], [1.05, -0.2, 2.2]], "reaching far": [[0.3, 0.9, 0.5]],
    "turn, then lower": [[1.05, -0.3, 1.6]]}  # points between, rad

cylinder = np.eye(4)
cylinder[:3, 3] = 0.42, 0.56, 0.15  # metres
targets = [penumbra.Target("cylinder", penumbra.BoxTarget(cylinder, [0.1, 0.1, 0.3], frame="")),
           penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], frame=""))]

given = penumbra.open(pathlib.Path(__file__).parent.parent / "arm_over_table")
camera = penumbra.ForecastCamera("cell", given.camera)
start = given[0].pose
ahead = penumbra.LookAhead(given.robot, [camera], targets, start)
forecasts = []
for between in WAYS.values():
    points = [START, *between, GRASP]
    times = np.linspace(0, 3, len(points))
    forecasts.append(ahead.along(penumbra.Trajectory(given.robot, JOINTS, times, points, start)))
for each in penumbra.rank(forecasts):
    print(f"{list(WAYS)[each.trajectory]:17} {100 * each.seen:3.0f} % seen  {each.reason}")
