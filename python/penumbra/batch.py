# SPDX-License-Identifier: Apache-2.0
"""Judges many recordings and bags at once, on this machine or on a cluster of Dask's.

python3 -m penumbra.batch INPUT... -o OUT [-- options of penumbra run]
"""

from __future__ import annotations

import argparse
import collections
import csv
import ctypes
import glob
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from penumbra import InputError, __version__

__all__ = ["run"]

program = pathlib.Path(__file__).parent.absolute() / "bin" / "penumbra"
record_name = "batch.json"
part_mark = ".part-"
nothing_judged = 2  # exit status of penumbra run
libc = ctypes.CDLL(None)
# A worker that dies is not the input's fault: the scheduler gives the input to another one.
most_deaths = 100

columns = (
    "input", "result", "status", "fault", "frames", "bad_frames", "seconds", "bytes",
    "pixels_robot", "pixels_front", "pixels_occluded", "pixels_unknown", "pixels_beyond",
    "pixels_fringe", "targets", "visible", "partial", "hidden", "unknown", "out_of_view", "held",
    "penumbra",
)  # fmt: skip


def _files_of(path: pathlib.Path) -> Iterable[pathlib.Path]:
    return sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else [path]


def _fingerprint(path: pathlib.Path, options: Sequence[str]) -> str:
    """Of the input's own files by name, size and time, the options and this version."""
    hashed = hashlib.sha256(json.dumps([__version__, str(path), list(options)]).encode())
    for file in _files_of(path):
        try:
            stat = file.stat()
        except FileNotFoundError:
            continue
        hashed.update(f"{file}\0{stat.st_size}\0{stat.st_mtime_ns}\n".encode())
    return hashed.hexdigest()


def _result_name(path: pathlib.Path) -> str:
    """Two inputs of one name have results of two."""
    return f"{path.name}-{hashlib.sha256(str(path).encode()).hexdigest()[:8]}"


def _die_with_parent() -> None:
    set_death_signal = 1
    libc.prctl(set_death_signal, signal.SIGKILL)


def _numbers(reports: Iterable[pathlib.Path]) -> dict[str, Any]:
    """The sums over the reports, one of each camera."""
    numbers: collections.Counter[str] = collections.Counter()
    for report in reports:
        with report.open(encoding="utf-8") as file:
            summary = json.load(file)["summary"]
        numbers.update({"frames": summary["frames"], "bad_frames": summary["bad_frames"]})
        numbers.update({f"pixels_{label}": n for label, n in summary["pixels"].items()})
        numbers.update({"targets": len(summary["targets"])})
        for target in summary["targets"]:
            numbers.update(target["verdicts"])
    return dict(numbers)


def _judge(path: str, options: Sequence[str], output: str, fingerprint: str) -> dict[str, Any]:
    """Runs on a worker. Replaces the input's result, whole, and returns its record."""
    folder = pathlib.Path(output) / _result_name(pathlib.Path(path))
    for former in folder.parent.glob(f".{glob.escape(folder.name)}{part_mark}*"):
        shutil.rmtree(former, ignore_errors=True)  # of a worker that died
    part = folder.parent / f".{folder.name}{part_mark}{uuid.uuid4().hex[:8]}"
    part.mkdir(parents=True)
    threads = [] if "--threads" in options else ["--threads", "1"]
    start = time.monotonic()
    done = subprocess.run(
        [program, "run", path, "-o", part / "run", *threads, *options],
        capture_output=True, text=True, errors="replace", preexec_fn=_die_with_parent,
        start_new_session=True, check=False,
    )  # fmt: skip
    if done.returncode not in (0, nothing_judged):  # not the input's fault: it is tried again
        shutil.rmtree(part, ignore_errors=True)
        raise RuntimeError(f"{path}: penumbra run ended with status {done.returncode}")
    record = {"input": path, "result": folder.name, "status": "done", "penumbra": __version__}
    if done.returncode == 0:
        record |= _numbers((part / "run").rglob("report.json"))
    else:
        lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        record |= {"status": "failed", "fault": lines[-1].removeprefix("penumbra: ")}
        shutil.rmtree(part / "run", ignore_errors=True)
    record["seconds"] = round(time.monotonic() - start, 3)
    record["bytes"] = sum(file.stat().st_size for file in _files_of(part))
    text = json.dumps({"fingerprint": fingerprint, "record": record}, indent=1)
    (part / record_name).write_text(text, encoding="utf-8")
    if folder.exists():
        folder.rename(part.with_name(f"{part.name}-former"))
    part.rename(folder)
    shutil.rmtree(part.with_name(f"{part.name}-former"), ignore_errors=True)
    return record


def _former_record(folder: pathlib.Path, fingerprint: str) -> dict[str, Any] | None:
    """The record of a result that is still valid."""
    try:
        kept = json.loads((folder / record_name).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return kept["record"] if kept.get("fingerprint") == fingerprint else None


def _inputs(given: Iterable[str]) -> list[tuple[str, list[str]]]:
    """Absolute paths, each once, with options of their own."""
    found: dict[str, list[str]] = {}
    for name in given:
        if name.endswith(".txt"):
            try:
                lines = pathlib.Path(name).read_text(encoding="utf-8").splitlines()
            except (OSError, UnicodeDecodeError) as error:
                raise InputError(f"{name}: the list cannot be read: {error}") from None
            for line in lines:
                words = shlex.split(line, comments=True)
                if words:
                    path = os.path.abspath(pathlib.Path(name).parent / words[0])
                    found[path.removesuffix("/recording.yaml")] = words[1:]
            continue
        paths = [name] if os.path.lexists(name) else sorted(glob.glob(name))
        for path in paths or [name]:  # `penumbra run` says what is wrong
            found[os.path.abspath(path).removesuffix("/recording.yaml")] = []
    if not found:
        raise InputError("no input is given")
    return list(found.items())


def _write_summary(file: pathlib.Path, records: Sequence[dict[str, Any]]) -> None:
    part = file.with_name(f".{file.name}{part_mark}{os.getpid()}")
    if file.suffix == ".parquet":
        try:
            import pyarrow
            import pyarrow.parquet
        except ImportError:
            raise InputError(f"{file}: needs Python's pyarrow; choose a name in .csv") from None
        table = pyarrow.table({name: [r.get(name) for r in records] for name in columns})
        pyarrow.parquet.write_table(table, part)
    else:
        with part.open("w", encoding="utf-8", newline="") as out:
            writer = csv.DictWriter(out, columns, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(records)
    part.replace(file)


def run(
    inputs: Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    options: Sequence[str] = (),
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    summary: str = "summary.csv",
    told: Callable[[int, int, dict[str, Any]], None] = lambda done, all_inputs, record: None,
) -> list[dict[str, Any]]:
    """Runs `penumbra run` on each input and returns a record of each, in their order.

    inputs: recordings, bags, patterns ("day1/*.mcap") and lists (*.txt: an input a line, with
        options of its own behind it).
    output: a folder. Each input's result is in output/NAME-HASH: run/ as `penumbra run` writes it
        and batch.json. A result appears whole or not at all. A valid one is not made again: its
        input's files, the options and Penumbra's version are as they were.
    options: of `penumbra run`, for all inputs.
    workers: processes on this machine, each with one thread; None: one per core.
    scheduler: the address of a running Dask scheduler, "tcp://HOST:PORT", in place of `workers`.
        Its workers see inputs and output under the same paths.
    summary: file in output, in .csv or .parquet: a line per input.
    told: called with the number of finished inputs, that of all, and the newest record.

    A record has "status": "done" or "failed" with a "fault"; "seconds", "bytes" of the result,
    "frames", "bad_frames", numbers of pixels by label and of verdicts over all targets.
    Raises InputError for no input, an output that cannot be written, and a scheduler that does not
    answer.
    """
    jobs = _inputs(str(name) for name in inputs)
    if not program.exists():
        raise InputError(f"{program} is not there; install the package again")
    folder = pathlib.Path(output).absolute()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made: {error.strerror}") from None
    records: dict[str, dict[str, Any]] = {}
    waiting = []
    for path, own in jobs:
        all_options = [*options, *own]
        fingerprint = _fingerprint(pathlib.Path(path), all_options)
        former = _former_record(folder / _result_name(pathlib.Path(path)), fingerprint)
        if former:
            records[path] = former
            told(len(records), len(jobs), former)
        else:
            waiting.append((path, all_options, str(folder), fingerprint))
    if waiting:
        for record in _on_cluster(waiting, workers, scheduler):
            records[record["input"]] = record
            told(len(records), len(jobs), record)
    ordered = [records[path] for path, _ in jobs]
    _write_summary(folder / summary, ordered)
    return ordered


def _on_cluster(
    jobs: Sequence[tuple[str, list[str], str, str]], workers: int | None, scheduler: str | None
) -> Iterable[dict[str, Any]]:
    try:
        import dask
        import distributed
    except ImportError:
        raise InputError("needs Dask: python3-distributed, or pip install penumbra[batch]") from None
    with dask.config.set({"distributed.scheduler.allowed-failures": most_deaths}):
        try:
            client = (
                distributed.Client(scheduler, timeout="10s")
                if scheduler
                else distributed.Client(
                    n_workers=workers or os.cpu_count(), threads_per_worker=1, processes=True,
                    dashboard_address="127.0.0.1:0",
                )
            )  # fmt: skip
        except (OSError, ValueError) as error:
            raise InputError(f"scheduler {scheduler}: does not answer ({error})") from None
        with client:
            print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
            path_of = {client.submit(_judge, *job, pure=False): job[0] for job in jobs}
            for future in distributed.as_completed(list(path_of)):
                path = path_of.pop(future)
                try:
                    record = future.result()
                except Exception as error:  # its workers died, a disk is full: not kept
                    record = {"input": path, "result": "", "status": "failed", "fault": str(error)}
                # Or the death of the worker that holds it would have it made again.
                future.release()
                yield record


def _print_progress(done: int, all_inputs: int, record: dict[str, Any]) -> None:
    if record["status"] == "failed":
        path, fault = record["input"], record["fault"]
        print(f"\rpenumbra: {fault if path in fault else f'{path}: {fault}'}", file=sys.stderr)
    if sys.stderr.isatty():
        bar = "#" * (40 * done // all_inputs)
        end = "\n" if done == all_inputs else ""
        print(f"\r[{bar:<40}] {done}/{all_inputs}", end=end, file=sys.stderr, flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m penumbra.batch",
        usage="%(prog)s INPUT... -o OUT [--workers N | --scheduler ADDRESS] [-- OPTION...]",
        description="Judges many recordings and bags with `penumbra run`, on all cores or on a "
        "cluster of Dask's. What is done and unchanged is not done again.",
        epilog="Options behind -- are those of `penumbra run`: -- --save labels. Exit status: 0; "
        "1 if an input failed; 2 if all failed or the arguments are wrong.",
        allow_abbrev=False,
    )
    parser.add_argument("inputs", nargs="*", metavar="INPUT",
                        help="recording, bag, 'pattern*.mcap', or list.txt: an input a line, with "
                        "options of its own behind it")  # fmt: skip
    parser.add_argument("-o", "--output", required=True, help="folder for results and summary")
    parser.add_argument("--workers", type=int, help="processes here; default: one per core")
    parser.add_argument("--scheduler", help="tcp://HOST:PORT of a running cluster instead")
    parser.add_argument("--summary", default="summary.csv", help="its name: *.csv or *.parquet")
    arguments = sys.argv[1:]
    end = arguments.index("--") if "--" in arguments else len(arguments)
    known, options = parser.parse_args(arguments[:end]), arguments[end + 1 :]
    if known.workers is not None and known.workers < 1:
        parser.error("--workers: 1 or more")
    try:
        records = run(known.inputs, known.output, options, workers=known.workers,
                      scheduler=known.scheduler, summary=known.summary,
                      told=_print_progress)  # fmt: skip
    except InputError as error:
        print(f"penumbra: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    failed = sum(record["status"] == "failed" for record in records)
    summary = pathlib.Path(known.output) / known.summary
    print(f"{len(records) - failed} done, {failed} failed: {summary}")
    return 0 if failed == 0 else 2 if failed == len(records) else 1


if __name__ == "__main__":
    from penumbra import batch  # workers import it by this name

    sys.exit(batch.main())
