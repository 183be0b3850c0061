# SPDX-License-Identifier: Apache-2.0
"""How much of each target the robot hides, over time: python3 plot_occlusion.py RECORDING OUT.png"""
import sys
from typing import Dict, List

import matplotlib.pyplot as plt  # type: ignore[import]
import numpy as np

import penumbra

given = penumbra.open(sys.argv[1])
session = penumbra.Session(given.robot, given.camera, given.config)
targets = given.open_targets()
frames: Dict[str, List[int]] = {}
hidden: Dict[str, List[float]] = {}
for frame in given:
    assert frame.index is not None
    report = session.process(frame.replace(targets=targets.of_frame(frame.index)))
    for target in report.targets:
        frames.setdefault(target.name, []).append(report.index)
        share = target.judgement.occluded if target.judgement else np.nan
        hidden.setdefault(target.name, []).append(100 * share)

for name in frames:
    plt.plot(frames[name], hidden[name], "o-", label=name)
plt.xlabel("frame")
plt.ylabel("hidden by the robot (% of the target's pixels)")
plt.legend()
plt.savefig(sys.argv[2])
