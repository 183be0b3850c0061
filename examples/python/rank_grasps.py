# SPDX-License-Identifier: Apache-2.0
"""Which of five ways to a grasp keeps the targets in view: python3 rank_grasps.py OUT.png

The arm of the shipped recording turns to the side. The ways pass other points, in 3 s each.
"""

import pathlib
import sys
from typing import Dict, List

import matplotlib.pyplot as plt  # type: ignore[import]
import numpy as np

import penumbra

RECORDING = pathlib.Path(__file__).parent.parent / "arm_over_table"
JOINTS = ["shoulder_pan", "shoulder_lift", "elbow"]
START, GRASP = [-0.7, 0.5, 1.25], [1.05, 0.55, 1.4]  # rad
WAYS: Dict[str, List[List[float]]] = {
    "straight": [], "over the top": [[-0.7, -0.4, 0.9], [1.05, -0.4, 0.9]],
    "arm folded": [[-0.7, -0.2, 2.2], [1.05, -0.2, 2.2]], "reaching far": [[0.3, 0.9, 0.5]],
    "turn, then lower": [[1.05, -0.3, 1.6]]}  # points between, rad


def targets() -> List[penumbra.Target]:
    cylinder = np.eye(4)
    cylinder[:3, 3] = 0.42, 0.56, 0.15
    return [penumbra.Target("cylinder", penumbra.BoxTarget(cylinder, [0.1, 0.1, 0.3], frame="")),
            penumbra.Target("lid", penumbra.PointTarget([0.42, 0.56, 0.30], frame=""))]


def main(out: str) -> None:
    given = penumbra.open(RECORDING)
    camera = penumbra.ForecastCamera("cell", given.camera)
    start = given[0].pose
    ahead = penumbra.LookAhead(given.robot, [camera], targets(), start)
    forecasts: Dict[str, List[penumbra.TargetForecast]] = {}
    for name, between in WAYS.items():
        points = [START] + between + [GRASP]
        way = penumbra.Trajectory(given.robot, JOINTS, np.linspace(0, 3, len(points)), points, start)
        forecasts[name] = list(ahead.along(way))
    ranked = penumbra.rank(list(forecasts.values()))
    names = [list(forecasts)[each.trajectory] for each in ranked]
    for name, each in zip(names, ranked):
        print(f"{name:17} {100 * each.seen:3.0f} % seen  {each.reason}")
    figure, axes = plt.subplots(len(names), sharex=True, sharey=True, figsize=(8, 7),
                                layout="constrained")
    for axis, name, each in zip(axes, names, ranked):
        for target in forecasts[name]:
            axis.plot(target.cameras[0].times, 100 * target.cameras[0].hidden, label=target.name)
        axis.set_title(f"{name}: {100 * each.seen:.0f} % seen", loc="left", fontsize="medium")
        axis.grid(alpha=0.3)
    axes[0].legend()
    axes[-1].set_xlabel("time (s)")
    figure.supylabel("hidden share (%)")
    figure.savefig(out, dpi=120)


if __name__ == "__main__":
    main(sys.argv[1])
