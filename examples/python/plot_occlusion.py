# SPDX-License-Identifier: Apache-2.0
"""How much of each target the robot hides, over time: python3 plot_occlusion.py RECORDING OUT.png"""

import sys
from typing import Dict, List, Tuple

import matplotlib.pyplot as plt  # type: ignore[import]
import numpy as np

import penumbra
from penumbra import Verdict

# Okabe and Ito's colours, which colour-blind people can distinguish.
COLORS = {Verdict.visible: "#009e73", Verdict.partial: "#e69f00", Verdict.hidden: "#d55e00",
          Verdict.unknown: "#999999", Verdict.out_of_view: "#56b4e9", Verdict.held: "#0072b2"}


def judge(source: str) -> Dict[str, List[penumbra.TargetReport]]:
    """Each target's reports, one per frame."""
    given = penumbra.open(source)
    if given.targets is None:
        sys.exit(f"{source}: has no targets")
    session = penumbra.Session(given.robot, given.camera, given.config)
    targets = penumbra.TargetsFile.open(
        given.targets, robot=given.robot, image=given.config.image, images=session.intrinsics,
        has_distortion=not given.camera.distortion.is_none,
        beyond_hides=given.beyond is not penumbra.BeyondMeans.visible)
    judged: Dict[str, List[penumbra.TargetReport]] = {}
    for frame in given:
        assert frame.index is not None
        with_targets = frame.replace(targets=targets.of_frame(frame.index))
        for target in session.process(with_targets).targets:
            judged.setdefault(target.name, []).append(target)
    return judged


def hidden(target: penumbra.TargetReport) -> Tuple[float, float]:
    """Percent of its pixels in the image, by the robot and by all; nan where none were judged."""
    judgement = target.judgement
    if judgement is None or judgement.inside == 0:
        return np.nan, np.nan
    by_robot = 100 * judgement.occluded
    return by_robot, by_robot + 100 * (judgement.hidden_by_other or 0)


def times_of(reports: List[penumbra.TargetReport]) -> Tuple[List[float], str]:
    """Seconds since the first one, or numbers where there are no stamps; and what they are."""
    stamps = [report.stamp for report in reports if report.stamp is not None]
    if len(stamps) < len(reports):
        return [float(i) for i in range(len(reports))], "frame"
    return [1e-9 * (stamp - stamps[0]) for stamp in stamps], "time (s)"


def plot(judged: Dict[str, List[penumbra.TargetReport]], file: str) -> None:
    figure, axes = plt.subplots(len(judged), sharex=True, squeeze=False,
                                figsize=(8, 1.5 + 1.4 * len(judged)), layout="constrained")
    for axis, (name, reports) in zip(axes[:, 0], judged.items()):
        times, unit = times_of(reports)
        by_robot, by_all = zip(*(hidden(report) for report in reports))
        axis.fill_between(times, by_robot, color="#bbbbbb", label="by the robot")
        axis.plot(times, by_all, color="#555555", zorder=1, label="by anything")
        for verdict, color in COLORS.items():
            of_it = [i for i, report in enumerate(reports) if report.verdict is verdict]
            heights = [np.nan_to_num(by_all[i]) for i in of_it]
            axis.scatter([times[i] for i in of_it], heights, color=color, s=36, zorder=2,
                         label=verdict.value.replace("_", " "))
        axis.set(ylabel=name, ylim=(-8, 108))
        axis.grid(alpha=0.3)
    axes[-1, 0].set_xlabel(unit)
    figure.suptitle("Hidden share of each target's pixels (%), and its verdict")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0), ncol=len(labels))
    figure.savefig(file, dpi=120, bbox_inches="tight")


if __name__ == "__main__":
    plot(judge(sys.argv[1]), sys.argv[2])
