# SPDX-License-Identifier: Apache-2.0
"""Experiments from Python give what the command line gives."""

import json
import os
import subprocess

import numpy as np
import pytest

import penumbra
from conftest import PROGRAM, only_in_full, run

SEEDS = 2  # that confidence be made of more than one
SECONDS = 1.5  # of each run


@pytest.fixture(scope="module", autouse=True)
def simulation():
    if not penumbra.experiments():
        assert "simulation" not in os.environ.get("PENUMBRA_REQUIRE", "").split(","), "not built"
        pytest.skip("no simulation")


@pytest.fixture(scope="module")
def handover(tmp_path_factory):
    folder = tmp_path_factory.mktemp("handover")
    assert penumbra.run_experiment("handover", folder, end_seed=SEEDS, duration=SECONDS) is None
    return folder


@only_in_full
def test_files_are_the_command_lines(handover, tmp_path):
    run("experiment", "handover", "-o", tmp_path, "--seeds", f"0:{SEEDS}", "--duration", SECONDS,
        "--threads", 1)
    for name in ("metrics.json", "report.html"):
        assert (handover / name).read_bytes() == (tmp_path / name).read_bytes(), name
    assert sorted(os.listdir(handover)) == ["metrics.json", "report.html"]


@only_in_full
def test_metrics_are_those_of_their_seeds(handover):
    metrics = json.loads((handover / "metrics.json").read_text())
    assert metrics["experiment"] == "handover" and metrics["seeds"] == [0, SEEDS]
    assert metrics["penumbra"] == penumbra.__version__
    methods = metrics["detections"]["keypoint"]["methods"]
    assert {"raw", "urdf_filter", "penumbra"} <= methods.keys()
    for method in methods.values():
        assert [one["seed"] for one in method["seeds"]] == list(range(SEEDS))
        for key, measured in method["summary"].items():
            low, high = measured["ci95"] or (None, None)
            assert low is None or low <= measured["value"] <= high, key
    # Seconds without a pose are a run's: their mean is the summary's.
    for method in methods.values():
        seconds = [one["without_pose_s"] for one in method["seeds"]]
        assert method["summary"]["without_pose_s"]["value"] == pytest.approx(np.mean(seconds))


def test_seeds_and_frames_are_chosen(tmp_path):
    penumbra.run_experiment("conveyor", tmp_path, first_seed=7, end_seed=8, duration=0.2,
                            threads=1, frames=True)
    assert json.loads((tmp_path / "metrics.json").read_text())["seeds"] == [7, 8]
    assert len(list((tmp_path / "frames").glob("*.png"))) >= 5


def test_what_makes_no_sense_is_refused(tmp_path):
    with pytest.raises(penumbra.InputError) as caught:
        penumbra.run_experiment("lunch", tmp_path)
    told = subprocess.run([PROGRAM, "experiment", "lunch", "-o", tmp_path], capture_output=True,
                          text=True)
    assert told.returncode == 2 and str(caught.value) in told.stderr
    with pytest.raises(penumbra.InputError, match="3:3 is not A:B with A < B"):
        penumbra.run_experiment("conveyor", tmp_path, first_seed=3, end_seed=3)
    assert os.listdir(tmp_path) == []


def test_names_are_experiments():
    assert list(penumbra.experiments()) == ["conveyor", "handover"]
