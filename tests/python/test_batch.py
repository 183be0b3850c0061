# SPDX-License-Identifier: Apache-2.0
"""Many inputs on Dask's workers."""

import csv
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import penumbra.batch
from conftest import refuses, run, run_python, SHIPPED

distributed = pytest.importorskip("distributed")

IN_FULL = bool(os.environ.get("PENUMBRA_FULL"))
INPUTS = 200 if IN_FULL else 12
BROKEN = 5
RESULTS_BETWEEN_KILLS = 20 if IN_FULL else 4
OPTIONS = ["--save", "labels,overlay", "--frames", "0:6"]
TARGETS = "targets: [{name: it, box: [460, 172, 38, 98], expected_depth: 1.87, depth_margin: 0.1}]"
ONE_FRAME = ["--frames", "0:1"]
NO_SCHEDULER = "tcp://127.0.0.1:1"


def make_inputs(folder, count):
    """The shipped recording with its joints moved, and broken ones."""
    folder.mkdir()
    for i in range(count):
        made = folder / f"{'broken' if i < BROKEN else 'recording'}_{i}"
        made.mkdir()
        for part in SHIPPED.iterdir():
            if part.name != "joint_states.csv":
                (made / part.name).symlink_to(part)
        rows = list(csv.reader((SHIPPED / "joint_states.csv").open()))
        for row in rows[1:]:
            row[2] = str(float(row[2]) + 1e-3 * i)
            if i < BROKEN:
                row[2:] = ["no number"] * len(row[2:])
        with (made / "joint_states.csv").open("w", newline="") as out:
            csv.writer(out).writerows(rows)
    return folder


def start(folder, out, where=("--workers", "2")):
    command = [sys.executable, "-m", "penumbra.batch", str(folder / "*"), "-o", str(out), *where, "--", *OPTIONS]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)


def busy_workers_of(pid):
    """Dask's worker processes that run `penumbra run`."""
    parents = {}
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            stat = (process / "stat").read_text()
            parents[int(process.name)] = int(stat.rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
    return sorted({parent for parent in parents.values() if parents.get(parent) == pid})


def rows_of(out):
    return list(csv.DictReader((out / "summary.csv").open()))


def results_of(out):
    return list(out.glob("*/batch.json"))


def times_of(out):
    """When each result was made."""
    return {path.parent.name: path.stat().st_mtime_ns for path in results_of(out)}


def finish(batch, out=None, rng=None):
    """Waits for it, and with rng kills workers now and then. Returns the number of kills."""
    kills = 0
    while batch.poll() is None:
        time.sleep(0.02)
        due = rng and len(results_of(out)) > kills * RESULTS_BETWEEN_KILLS
        workers = busy_workers_of(batch.pid) if due else []
        if workers:
            os.kill(rng.choice(workers), signal.SIGKILL)
            kills += 1
    batch.err = batch.communicate()[1]
    return kills


def without_times(report):
    report = json.loads(report.read_text())
    report["summary"].pop("timing_ms")
    for frame in report["frames"]:
        frame.pop("timing_ms")
    return report


def expect_single_run(row, out, folder):
    """The result is that of `penumbra run`."""
    alone = folder / "alone"
    run("run", row["input"], "-o", alone, *OPTIONS)
    result = out / row["result"] / "run"
    names = {path.relative_to(alone) for path in alone.rglob("*.*")}
    assert names == {path.relative_to(result) for path in result.rglob("*.*")}
    assert len(names) > 3
    for name in names - {pathlib.Path("report.json")}:
        assert (alone / name).read_bytes() == (result / name).read_bytes()
    assert without_times(result / "report.json") == without_times(alone / "report.json")
    shutil.rmtree(alone)


def test_each_input_has_one_result_though_workers_die(tmp_path):
    folder, out = make_inputs(tmp_path / "in", INPUTS), tmp_path / "out"
    batch = start(folder, out)
    kills = finish(batch, out, random.Random(4))
    assert batch.returncode == 1, batch.err
    assert kills > 0
    rows = rows_of(out)
    assert [row["input"] for row in rows] == sorted(str(path) for path in folder.iterdir())
    failed = [row for row in rows if row["status"] == "failed"]
    assert len(failed) == BROKEN
    assert all("joint_states.csv" in row["fault"] for row in failed)
    left = {path.name for path in out.iterdir()}
    assert left == {row["result"] for row in rows} | {"summary.csv"}
    good = [row for row in rows if row["status"] == "done"]
    assert len(good) == INPUTS - BROKEN
    assert [row["cause"] for row in good if row["input"].endswith("_5")] == ["none"]
    for row in good:
        expect_single_run(row, out, tmp_path)

    times = times_of(out)
    again = start(folder, out, ["--scheduler", NO_SCHEDULER])
    finish(again)
    assert again.returncode == 1, "no cluster is needed where nothing is to be done"
    os.utime(pathlib.Path(good[0]["input"]) / "joint_states.csv")
    finish(start(folder, out))
    now = times_of(out)
    assert [name for name in times if now[name] != times[name]] == [good[0]["result"]]
    assert rows_of(out)[-1] == rows[-1]


def test_after_an_interrupt_only_the_rest_is_done(tmp_path):
    folder, out = make_inputs(tmp_path / "in", 12), tmp_path / "out"
    batch = start(folder, out)
    while not results_of(out) and batch.poll() is None:
        time.sleep(0.01)
    os.killpg(batch.pid, signal.SIGINT)
    finish(batch)
    assert batch.returncode == 128 + signal.SIGINT, batch.err
    kept = times_of(out)
    assert 0 < len(kept) < 12
    finish(start(folder, out))
    now = times_of(out)
    assert len(now) == 12 and kept.items() <= now.items()
    assert {row["result"] for row in rows_of(out)} == set(now)


def test_a_list_has_options_and_a_function_does_the_same(tmp_path):
    inputs = tmp_path / "inputs.txt"
    inputs.write_text(f"# a comment\n{SHIPPED} --frames 0:2\n")
    told = []
    records = penumbra.batch.run([inputs], tmp_path / "out", workers=1,
                                 on_progress=lambda done, all_inputs, record: told.append(done))
    assert [record["frames"] for record in records] == [2]
    assert [record["cause"] for record in records] == ["not judged"]
    assert told == [1]


def masked_episode(folder, pose, guess):
    """The shipped recording without depth, with the masks that a camera at `pose` sees."""
    shutil.copytree(SHIPPED, folder)
    np.savetxt(folder / "camera_pose.csv", pose, delimiter=",")
    run("run", folder, "-o", folder / "seen", "--save", "robot_mask")
    np.savetxt(folder / "camera_pose.csv", guess, delimiter=",")
    text = (folder / "recording.yaml").read_text()
    (folder / "recording.yaml").write_text("".join(line for line in text.splitlines(True) if "depth:" not in line))
    return folder


def test_episodes_tell_where_their_camera_is_and_when_it_moved(tmp_path):
    pose = np.loadtxt(SHIPPED / "camera_pose.csv", delimiter=",")
    guess, moved = pose.copy(), pose.copy()
    guess[:3, 3] += [0.03, -0.02, 0.03]
    moved[:3, 3] += [0.0, 0.03, 0.0]
    masks = ["--masks", "seen/robot_mask/%06d.png"]
    episodes = [masked_episode(tmp_path / f"episode_{i}", moved if i == 2 else pose, guess) for i in range(3)]
    episodes.append(tmp_path / "no_episode")
    records, cameras = penumbra.batch.calibrate(episodes, tmp_path / "out", masks, workers=2)
    assert [record["status"] for record in records] == ["done"] * 3 + ["failed"]
    assert [len(camera["inputs"]) for camera in cameras] == [2, 1]
    assert cameras[1]["inputs"] == [str(episodes[2])]
    limit = 2.0  # millimetres: docs/calibration.md
    for camera, truth in zip(cameras, (pose, moved)):
        found = np.array(camera["T_parent_camera"])
        assert 1e3 * np.linalg.norm(found[:3, 3] - truth[:3, 3]) < limit
    assert cameras[0]["moved_mm"] == 0
    assert cameras[1]["moved_mm"] == pytest.approx(30, abs=2 * limit)
    assert [record["camera_off_mm"] for record in records[:3]] == pytest.approx([0, 0, 30], abs=2 * limit)
    assert json.loads((tmp_path / "out/cameras.json").read_text()) == cameras

    told = run_python("-m", "penumbra.batch", "--calibrate", *episodes, "-o", tmp_path / "out", "--", *masks,
                      status=1).stdout  # one failed
    assert "in 2 inputs" in told and "degrees before" in told


@pytest.fixture(scope="module")
def scheduler():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster:
        yield cluster.scheduler_address


def test_a_scheduler_has_few_inputs_at_a_time_and_relative_paths(tmp_path, scheduler, monkeypatch):
    for name in ("a", "b/deep", "c"):
        (tmp_path / "in" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "in" / name).symlink_to(SHIPPED)
    (tmp_path / "relative.yaml").write_text(TARGETS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(penumbra.batch, "most_waiting", 1)
    records = penumbra.batch.run(["in/**/recording.yaml"], "out", ["--targets", "relative.yaml"], scheduler=scheduler)
    assert [pathlib.Path(record["input"]).name for record in records] == ["a", "deep", "c"]
    assert {record["status"] for record in records} == {"done"}


def test_failed_inputs_are_done_again_if_asked(tmp_path, scheduler):
    targets = tmp_path / "targets.yaml"

    def status(**options):
        [record] = penumbra.batch.run([SHIPPED], tmp_path / "out", ["--targets", str(targets)],
                                      scheduler=scheduler, **options)
        return record["status"]

    assert status() == "failed"
    targets.write_text(TARGETS)
    assert status() == "failed"
    assert status(retry_failed=True) == "done"
    targets.unlink()
    assert status(retry_failed=True) == "done", "it did not fail"


def judge(out, scheduler, *options):
    [record] = penumbra.batch.run([SHIPPED], out, [*ONE_FRAME, *options], scheduler=scheduler)
    return record


def test_a_result_without_its_report_is_made_again(tmp_path, scheduler):
    result = tmp_path / "out" / judge(tmp_path / "out", scheduler)["result"]
    for damaged in (result / "batch.json", result / "run"):
        shutil.rmtree(damaged) if damaged.is_dir() else damaged.write_text("[]")
        record = judge(tmp_path / "out", scheduler)
        assert record["status"] == "done" and (result / "run" / "report.json").exists()
        assert json.loads((result / "batch.json").read_text())["record"] == record


def test_a_table_of_others_is_not_replaced(tmp_path, scheduler):
    judge(tmp_path / "out", scheduler)
    (tmp_path / "out" / "summary.csv").write_text("mine")
    refuses("summary.csv", lambda: judge(tmp_path / "out", scheduler))
    assert (tmp_path / "out" / "summary.csv").read_text() == "mine"


def test_one_batch_at_a_time_writes_into_a_folder(tmp_path, scheduler):
    refused = []

    def judge_meanwhile(*_):
        with pytest.raises(penumbra.InputError) as error:
            penumbra.batch.run([SHIPPED], tmp_path / "out", scheduler=scheduler)
        refused.append(error)

    records = penumbra.batch.run([SHIPPED], tmp_path / "out", ONE_FRAME, scheduler=scheduler,
                                 on_progress=judge_meanwhile)
    assert refused and records[0]["status"] == "done"
    assert judge(tmp_path / "out", scheduler) == records[0], "the lock is free again"


@pytest.mark.parametrize("arguments, word", [
    (["-o", "out"], "no input"),
    (["none.txt", "-o", "out"], "none.txt"),
    (["quote.txt", "-o", "out"], "quote.txt:2"),
    (["loop", "-o", "out"], "loop"),
    ([str(SHIPPED), "-o", "out", "--scheduler", NO_SCHEDULER], NO_SCHEDULER),
    ([str(SHIPPED), "-o", "out", "--workers", "0"], "--workers"),
    ([str(SHIPPED), "-o", "/dev/null/out"], "/dev/null/out"),
    (["nothing_here", "-o", "out"], "nothing_here"),
])
def test_bad_arguments_are_one_line(arguments, word, tmp_path):
    (tmp_path / "quote.txt").write_text("recording\nanother's\n")
    (tmp_path / "loop").symlink_to("loop")
    told = run_python("-m", "penumbra.batch", *arguments, status=2, cwd=tmp_path).stderr
    assert any(word in line for line in told.splitlines() if "penumbra: " in line or "error: " in line), told
    # On a busy machine Dask prints tracebacks of its own, of workers that it waits for in vain.
    assert not [line for line in told.splitlines() if line.startswith("  File") and "/penumbra/" in line], told
