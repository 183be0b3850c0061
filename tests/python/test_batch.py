# SPDX-License-Identifier: Apache-2.0
"""Many inputs on Dask's workers, some of which are killed."""

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

import pytest

import penumbra.batch
from conftest import PROGRAM, SHIPPED

pytest.importorskip("distributed")

IN_FULL = bool(os.environ.get("PENUMBRA_FULL"))
INPUTS = 200 if IN_FULL else 12
BROKEN = 5
SECONDS_BETWEEN_KILLS = 5.0 if IN_FULL else 1.5
OPTIONS = ["--save", "labels"]


def make_inputs(folder):
    """The shipped recording with its joints moved, and broken ones."""
    for i in range(INPUTS):
        made = folder / f"{'broken' if i < BROKEN else 'recording'}_{i}"
        made.mkdir()
        for part in SHIPPED.iterdir():
            if part.name != "joint_states.csv":
                (made / part.name).symlink_to(part)
        rows = list(csv.reader((SHIPPED / "joint_states.csv").open()))
        for row in rows[1:]:
            row[2] = str(float(row[2]) + 1e-3 * i) if i >= BROKEN else "no number"
        with (made / "joint_states.csv").open("w", newline="") as out:
            csv.writer(out).writerows(rows)
    return folder


def start(folder, out, *more):
    command = [sys.executable, "-m", "penumbra.batch", str(folder / "*"), "-o", str(out),
               "--workers", "2", *more, "--", *OPTIONS]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def workers_of(pid):
    """Dask's worker processes."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = int((process / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if parent == pid and b"spawn_main" in (process / "cmdline").read_bytes():
                found.append(int(process.name))
        except (OSError, ValueError):
            continue
    return found


def finish(batch, rng=None):
    """Waits for it, while a worker is killed every few seconds. Returns the number of kills."""
    kills, next_kill = 0, time.monotonic() + SECONDS_BETWEEN_KILLS
    while batch.poll() is None:
        time.sleep(0.05)
        workers = workers_of(batch.pid) if rng and time.monotonic() > next_kill else []
        if workers:
            os.kill(rng.choice(workers), signal.SIGKILL)
            kills, next_kill = kills + 1, time.monotonic() + SECONDS_BETWEEN_KILLS
    batch.out, batch.err = batch.communicate()
    return kills


def rows_of(out):
    return list(csv.DictReader((out / "summary.csv").open()))


def without_times(report):
    report = json.loads(report.read_text())
    report["summary"].pop("timing_ms")
    for frame in report["frames"]:
        frame.pop("timing_ms")
    return report


def expect_single_run(row, out, folder):
    """The result is that of `penumbra run`."""
    alone = folder / "alone"
    subprocess.run([PROGRAM, "run", row["input"], "-o", alone, *OPTIONS], check=True,
                   capture_output=True)
    result = out / row["result"] / "run"
    assert without_times(result / "report.json") == without_times(alone / "report.json")
    images = sorted((alone / "labels").iterdir())
    assert images
    for image in images:
        assert image.read_bytes() == (result / "labels" / image.name).read_bytes()
    shutil.rmtree(alone)


def test_each_input_has_one_result_though_workers_die(tmp_path):
    seed = 4
    print("seed", seed)
    (tmp_path / "in").mkdir()
    folder, out = make_inputs(tmp_path / "in"), tmp_path / "out"
    batch = start(folder, out)
    kills = finish(batch, random.Random(seed))
    print(kills, "workers killed")
    assert batch.returncode == 1, batch.err
    assert kills > 0
    rows = rows_of(out)
    assert [row["input"] for row in rows] == sorted(str(path) for path in folder.iterdir())
    failed = [row for row in rows if row["status"] == "failed"]
    assert len(failed) == BROKEN
    assert all("joint_states.csv" in row["fault"] for row in failed)
    results = {path.name for path in out.iterdir()}
    assert results == {row["result"] for row in rows} | {"summary.csv"}, "nothing is left over"
    good = [row for row in rows if row["status"] == "done"]
    assert len(good) == INPUTS - BROKEN
    for row in good[:: 20 if IN_FULL else 3]:
        expect_single_run(row, out, tmp_path)

    times = {path: (out / path / "batch.json").stat().st_mtime_ns for path in results
             if path != "summary.csv"}
    again = start(folder, out)
    finish(again)
    assert again.returncode == 1
    assert "dashboard" not in again.err, "no worker was started"
    changed = pathlib.Path(good[0]["input"]) / "joint_states.csv"
    os.utime(changed)
    finish(start(folder, out))
    now = {path: (out / path / "batch.json").stat().st_mtime_ns for path in times}
    assert [path for path in times if now[path] != times[path]] == [good[0]["result"]]
    assert rows_of(out)[-1] == rows[-1]


def test_a_list_has_options_and_a_function_does_the_same(tmp_path):
    inputs = tmp_path / "inputs.txt"
    inputs.write_text(f"# two of it\n{SHIPPED} --frames 0:2\n")
    told = []
    records = penumbra.batch.run([inputs], tmp_path / "out", workers=1,
                                 told=lambda done, all_inputs, record: told.append(done))
    assert [record["frames"] for record in records] == [2]
    assert told == [1]


@pytest.mark.parametrize("arguments, words", [
    (["-o", "out"], ["no input"]),
    (["none.txt", "-o", "out"], ["none.txt"]),
    ([str(SHIPPED), "-o", "out", "--scheduler", "tcp://127.0.0.1:1"], ["127.0.0.1:1", "answer"]),
    ([str(SHIPPED), "-o", "out", "--workers", "0"], ["--workers"]),
    ([str(SHIPPED), "-o", "/dev/null/out"], ["/dev/null/out"]),
    (["nothing_here", "-o", "out"], ["nothing_here"]),
])
def test_bad_arguments_are_one_line(arguments, words, tmp_path):
    done = subprocess.run([sys.executable, "-m", "penumbra.batch", *arguments], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode == 2
    last = done.stderr.strip().splitlines()[-2:]
    assert all(any(word in line for line in last) for word in words), done.stderr
    assert "Traceback" not in done.stderr
