# SPDX-License-Identifier: Apache-2.0
"""Judges or calibrates many recordings and bags at once, on this machine or on a cluster of Dask's.

python3 -m penumbra.batch INPUT... -o OUT [-- options of penumbra run]
python3 -m penumbra.batch --calibrate INPUT... -o OUT [-- options of penumbra calibrate]
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import csv
import ctypes
import errno
import fcntl
import glob
import hashlib
import importlib
import itertools
import json
import os
import pathlib
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from penumbra import InputError, __version__, camera_poses

__all__ = ["calibrate", "run"]

program = pathlib.Path(__file__).parent.absolute() / "bin" / "penumbra"
record_name = "batch.json"
most_record_bytes = 1 << 20
part_name = ".part"  # folder of unfinished results
summary_name = "summary.csv"
nothing_judged = 2  # exit status of penumbra run
least_poses = 3  # of the robot, that tell about a setup
libc = ctypes.CDLL(None)
dask_settings = {
    # A worker that dies is not the input's fault: the scheduler gives the input to another one.
    "distributed.scheduler.allowed-failures": 100,
    # This long after a death the local cluster drops the worker for good if it is just restarting.
    "distributed.deploy.lost-worker-timeout": "1000 days",
    # Not Dask's MALLOC_TRIM_THRESHOLD_, with which each image is memory of its own, got and given
    # back: masks take three times as long.
    "distributed.nanny.pre-spawn-environ": {"OMP_NUM_THREADS": 1, "OPENBLAS_NUM_THREADS": 1},
    # By default Dask's watch over itself takes a tenth of a core of the local cluster.
    "distributed.worker.profile.interval": "1s",
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.tick.interval": "500ms",
    "distributed.admin.system-monitor.interval": "2s",
}
# Enough for all workers of a cluster; neither client nor scheduler holds a million jobs.
most_waiting = 1000

columns = (
    "input", "result", "status", "fault", "frames", "bad_frames", "seconds", "bytes",
    "pixels_robot", "pixels_front", "pixels_occluded", "pixels_unknown", "pixels_beyond",
    "pixels_fringe", "targets", "visible", "partial", "hidden", "unknown", "out_of_view", "held",
    "cause", "diagnosis", "camera_off_mm", "camera_off_degrees", "penumbra",
)  # fmt: skip


# Does an input with its options, in a working folder for their relative paths, and writes the
# result into a folder. Returns numbers for the record. Raises InputError for a faulty input.
Work = Callable[[str, list[str], str, pathlib.Path], dict[str, Any]]
# Work, input, options, working folder, fingerprint and the result's folder.
_Job = tuple[Work, str, list[str], str, str, pathlib.Path]
Progress = Callable[[int, int, dict[str, Any]], None]


def _files_of(path: str | os.PathLike[str]) -> list[pathlib.Path]:
    if not os.path.isdir(path):
        return [pathlib.Path(path)]
    return sorted(pathlib.Path(at, name) for at, _, names in os.walk(path) for name in names)


def _fingerprint(path: str, options: Sequence[str], files: Iterable[pathlib.Path]) -> str:
    """Of the input's files by name, size and time, the options and this version."""
    hashed = hashlib.sha256(json.dumps([__version__, path, options]).encode())
    for file in files:
        try:
            status = file.stat()
        except OSError:  # the work says what is wrong
            continue
        hashed.update(os.fsencode(f"{file}\0{status.st_size}\0{status.st_mtime_ns}\n"))
    return hashed.hexdigest()


def _result_name(path: str) -> str:
    """Two inputs of one name have results of two."""
    return f"{pathlib.Path(path).name}-{hashlib.sha256(os.fsencode(path)).hexdigest()[:8]}"


def _die_with_parent() -> None:
    set_death_signal = 1
    libc.prctl(set_death_signal, signal.SIGKILL)


def _reports(result: pathlib.Path) -> Iterator[pathlib.Path]:
    """Of one camera in run/, of several in run/CAMERA/; or of its calibration."""
    yield from (result / "run").rglob("report.json")
    yield from (result / "run").glob("calibration.json")


def _numbers(reports: Iterable[pathlib.Path]) -> dict[str, Any]:
    """The sums over the reports, one of each camera, and what is wrong with their setups."""
    numbers: collections.Counter[str] = collections.Counter()
    causes, messages = [], []
    for report in reports:
        with report.open(encoding="utf-8") as file:
            summary = json.load(file)["summary"]
        numbers.update({"frames": summary["frames"], "bad_frames": summary["bad_frames"]})
        numbers.update({f"pixels_{label}": n for label, n in summary["pixels"].items()})
        numbers.update({"targets": len(summary["targets"])})
        for target in summary["targets"]:
            numbers.update(target["verdicts"])
        diagnosis = summary["diagnosis"]
        is_compared = summary["compared_poses"] >= least_poses
        causes.append(diagnosis["cause"] if diagnosis else "none" if is_compared else "not judged")
        messages += [diagnosis["message"]] if diagnosis else []
    return {**numbers, "cause": "; ".join(causes), "diagnosis": "; ".join(messages)}


def _remove_parts(output: pathlib.Path) -> None:
    """Renames them first, so that no job that still runs can complete a half-removed result."""
    removed = output / f"{part_name}-{uuid.uuid4().hex}"
    with contextlib.suppress(FileNotFoundError):
        (output / part_name).rename(removed)
        shutil.rmtree(removed, ignore_errors=True)


@contextlib.contextmanager
def _alone_in(output: pathlib.Path) -> Iterator[None]:
    """Makes the folder and that of unfinished results, and keeps other batches out."""
    with contextlib.ExitStack() as at_end:
        try:
            output.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(output, os.O_DIRECTORY)
            at_end.callback(os.close, descriptor)
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _check_summary(output)
            _remove_parts(output)
            (output / part_name).mkdir()
        except BlockingIOError:
            raise InputError(f"{output}: another batch is writing into it") from None
        except OSError as error:
            raise InputError(f"{output}: cannot be written: {error.strerror}") from None
        at_end.callback(_remove_parts, output)
        yield


def _penumbra_run(
    path: str, options: list[str], working_folder: str, part: pathlib.Path
) -> dict[str, Any]:
    threads = [] if "--threads" in options else ["--threads", "1"]
    return _numbers(_penumbra("run", path, [*threads, *options], working_folder, part))


def _penumbra_calibrate(
    path: str, options: list[str], working_folder: str, part: pathlib.Path
) -> dict[str, Any]:
    (file,) = _penumbra("calibrate", path, options, working_folder, part)
    found = json.loads(file.read_text(encoding="utf-8"))
    return {
        "frames": sum(frame["used"] for frame in found["frames"]),
        **{key: found[key] for key in ("camera_parent", "T_parent_camera", "covariance")},
    }


def _penumbra(
    command: str, path: str, options: list[str], working_folder: str, part: pathlib.Path
) -> list[pathlib.Path]:
    """Returns the reports."""
    done = subprocess.run(
        [program, command, path, "-o", part / "run", *options],
        capture_output=True, text=True, errors="surrogateescape", preexec_fn=_die_with_parent,
        start_new_session=True, check=False, cwd=working_folder,
    )  # fmt: skip
    fault = (done.stderr.strip().splitlines() or ["no message"])[-1].removeprefix("penumbra: ")
    reports = list(_reports(part)) if done.returncode == 0 else []
    if not reports and done.returncode != nothing_judged:  # not the input's fault: it is not kept
        raise RuntimeError(f"penumbra {command} gave no result (status {done.returncode}): {fault}")
    if not reports:
        raise InputError(fault)
    return reports


def _make_result(
    work: Work, path: str, options: list[str], working_folder: str, fingerprint: str,
    folder: pathlib.Path,
) -> dict[str, Any]:  # fmt: skip
    """Runs on a worker. Replaces the input's result, whole, and returns its record."""
    part = folder.parent / part_name / f"{folder.name}-{uuid.uuid4().hex}"
    part.mkdir()
    (part / record_name).touch()
    start = time.monotonic()
    record: dict[str, Any] = {"input": path, "result": folder.name, "penumbra": __version__}
    try:
        record |= {"status": "done", **work(path, options, working_folder, part)}
    except InputError as error:
        record |= {"status": "failed", "fault": str(error)}
        shutil.rmtree(part / "run", ignore_errors=True)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise
    record["seconds"] = round(time.monotonic() - start, 3)
    record["bytes"] = sum(file.stat().st_size for file in _files_of(part))
    with (part / record_name).open("r+", encoding="utf-8") as file:  # fails if it was removed
        json.dump({"fingerprint": fingerprint, "record": record}, file, indent=1)
    former = part.with_name(f"{part.name}-former")
    with contextlib.suppress(FileNotFoundError):
        folder.rename(former)
    part.rename(folder)
    shutil.rmtree(former, ignore_errors=True)
    return record


def _read_regular(file: pathlib.Path) -> bytes:
    """Returns the file's first bytes; refuses a link, and a pipe without waiting for it."""
    guards = os.O_NOFOLLOW | os.O_NONBLOCK
    with open(file, "rb", opener=lambda path, flags: os.open(path, flags | guards)) as opened:
        if not stat.S_ISREG(os.fstat(opened.fileno()).st_mode):
            raise OSError(errno.EINVAL, f"{file.name} is no regular file")
        return opened.read(most_record_bytes)


def _former_record(path: str, fingerprint: str, folder: pathlib.Path) -> dict[str, Any] | None:
    """Returns the record of a result that is whole and still valid."""
    try:
        kept = json.loads(_read_regular(folder / record_name))
        record: dict[str, Any] = kept["record"]
        is_valid = kept["fingerprint"] == fingerprint and record["input"] == path
        is_whole = {"done": any(_reports(folder)), "failed": "fault" in record}[record["status"]]
    except (OSError, ValueError, TypeError, LookupError, RecursionError):
        return None
    return record if is_valid and is_whole else None


def _inputs(
    given: Iterable[str | os.PathLike[str]], options: Sequence[str]
) -> list[tuple[str, list[str]]]:
    """Absolute paths, each once, with these options and their own."""
    found: dict[str, list[str]] = {}
    for name in map(str, given):
        if name.endswith(".txt"):
            place = name
            try:
                lines = pathlib.Path(name).read_text(encoding="utf-8").splitlines()
                for number, line in enumerate(lines, 1):
                    place = f"{name}:{number}"
                    words = shlex.split(line, comments=True)
                    if words:
                        path = os.path.abspath(pathlib.Path(name).parent / words[0])
                        found[path.removesuffix("/recording.yaml")] = words[1:]
            except (OSError, ValueError) as error:
                raise InputError(f"{place}: the list cannot be read: {error}") from None
            continue
        paths = [name] if os.path.lexists(name) else sorted(glob.glob(name, recursive=True))
        for path in paths or [name]:  # `penumbra run` says what is wrong
            found[os.path.abspath(path).removesuffix("/recording.yaml")] = []
    if not found:
        raise InputError("no input is given")
    return [(path, [*options, *own]) for path, own in found.items()]


def _check_summary(output: pathlib.Path) -> None:
    """It is replaced at the end, as a link is, but not the user's own."""
    summary = output / summary_name
    start = ",".join(columns[:3]).encode()
    if summary.is_symlink() or not summary.exists():
        return
    if not _read_regular(summary).startswith(start):
        raise OSError(errno.EEXIST, f"{summary_name} is not of penumbra; choose another folder")


def _write_summary(output: pathlib.Path, records: Sequence[dict[str, Any]]) -> None:
    part = output / part_name / summary_name
    with part.open("x", encoding="utf-8", errors="backslashreplace", newline="") as out:
        writer = csv.DictWriter(out, columns, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(records)
    part.replace(output / summary_name)


def run(
    inputs: Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    options: Sequence[str] = (),
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    on_progress: Progress = lambda done, all_inputs, record: None,
) -> list[dict[str, Any]]:
    """Runs `penumbra run` on each input and returns a record of each, in their order.

    inputs: recordings, bags, patterns ("day1/**/*.mcap") and lists (*.txt: an input a line,
        followed by options of its own, quoted as in a shell).
    output: a folder, of one call at a time. Each input's result is in output/NAME-HASH: run/ as
        `penumbra run` writes it and batch.json. A result appears whole or not at all. A valid one
        is not made again: its input's files, the options and Penumbra's version are as they were.
        summary.csv has a line per input of this call.
    options: of `penumbra run`, for all inputs.
    workers: processes on this machine, each with one thread; None: one per core.
    scheduler: the address of a running Dask scheduler, "tcp://HOST:PORT", in place of `workers`.
        Its workers see the inputs, the output and the working folder under the same paths.
    retry_failed: does inputs again whose kept result is "failed".
    on_progress: called with the number of finished inputs, that of all, and the newest record.

    A record has "status": "done" or "failed" with a "fault"; "seconds", "bytes" of the result,
    "frames", "bad_frames", numbers of pixels by label and of verdicts over all targets; "cause" of
    a wrong setup, "none" or "not judged", and its "diagnosis".
    Raises InputError for no input, an output that cannot be written or that another call writes,
    and a scheduler that does not answer.
    """
    if not program.exists():
        raise InputError(f"{program} is not there; install the package again")
    return run_work(
        _penumbra_run, _inputs(inputs, options), _files_of, output, workers=workers, scheduler=scheduler,
        retry_failed=retry_failed, on_progress=on_progress,
    )  # fmt: skip


def calibrate(
    inputs: Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    options: Sequence[str] = (),
    **where: Any,
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Runs `penumbra calibrate` on each input, and says whether the camera moved between them.

    inputs: episodes of one camera, in the order in which they were recorded. options: of
    `penumbra calibrate`. where: workers, scheduler, retry_failed and on_progress of run().

    Returns the records and the camera's poses in turn, which are in output/cameras.json, too:
    "T_parent_camera" of all its inputs together, "covariance", "inputs", and how far it had moved
    when they began: "moved_mm" and "moved_degrees", 0 at first. "camera_off_mm" and
    "camera_off_degrees" of a record are from the pose of most inputs. Raises what run() raises.
    """
    given = _inputs(inputs, options)
    poses: list[dict[str, Any]] = []

    def compare(records: list[dict[str, Any]]) -> None:
        done = [record for record in records if record["status"] == "done"]
        poses.extend(camera_poses.of(done))
        camera_poses.add_distances(done, poses)

    records = run_work(_penumbra_calibrate, given, _files_of, output, at_end=compare, **where)
    text = json.dumps(poses, indent=1) + "\n"
    part = pathlib.Path(output, f"cameras.json-{uuid.uuid4().hex}{part_name}")
    part.write_text(text, encoding="utf-8")
    part.replace(part.with_name("cameras.json"))
    return records, poses


def run_work(
    work: Work,
    given: Sequence[tuple[str, list[str]]],
    files_of: Callable[[str], Iterable[pathlib.Path]],
    output: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    on_progress: Progress = lambda done, all_inputs, record: None,
    at_end: Callable[[list[dict[str, Any]]], None] = lambda records: None,
) -> list[dict[str, Any]]:
    """Does any work on inputs as run() does `penumbra run`.

    work: a function of a module; writes a report.json into run/ of the folder that it is given.
    given: inputs, each once, with their options. files_of: the files that an input is made of.
    at_end: may add to all records before the summary is written.
    """
    folder = pathlib.Path(output).absolute()
    records: dict[str, dict[str, Any]] = {}

    def keep(record: dict[str, Any]) -> None:
        records[record["input"]] = record
        on_progress(len(records), len(given), record)

    def jobs() -> Iterator[_Job]:
        for path, options in given:
            fingerprint = _fingerprint(path, options, files_of(path))
            result = folder / _result_name(path)
            former = _former_record(path, fingerprint, result)
            if former and not (retry_failed and former["status"] == "failed"):
                keep(former)
            else:
                yield work, path, options, os.getcwd(), fingerprint, result

    with _alone_in(folder):
        _run_on_cluster(jobs(), keep, workers, scheduler)
        ordered = [records[path] for path, _ in given]
        at_end(ordered)
        _write_summary(folder, ordered)
    return ordered


def _run_on_cluster(
    jobs: Iterator[_Job], keep: Callable[[dict[str, Any]], None], workers: int | None,
    scheduler: str | None,
) -> None:  # fmt: skip
    """Starts nothing if there is no job."""
    first = next(jobs, None)
    if first is None:
        return
    try:  # by their names, because few of their functions have types
        dask = importlib.import_module("dask")
        distributed = importlib.import_module("distributed")
    except ImportError:
        raise InputError("needs Dask: install python3-distributed, or penumbra[batch]") from None
    with dask.config.set(dask_settings):
        local = {"n_workers": workers, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
        try:
            client = distributed.Client(scheduler, timeout="10s", **({} if scheduler else local))
        except (OSError, ValueError, RuntimeError) as error:
            raise InputError(f"{scheduler or 'local workers'}: no answer ({error})") from None
        with client:
            print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
            # With results: to ask for one whose worker died would hold up all others.
            finished = distributed.as_completed([], with_results=True, raise_errors=False)
            path_of = {}

            def submit(more: Iterable[_Job]) -> None:
                for job in more:
                    future = client.submit(_make_result, *job, pure=False)
                    path_of[future] = job[1]
                    finished.add(future)

            submit(itertools.chain([first], itertools.islice(jobs, most_waiting - 1)))
            for future, record in finished:
                path = path_of.pop(future)
                # Or the death of the worker that holds it would have it made again.
                future.release()
                if not isinstance(record, dict):  # its workers died, a disk is full: not kept
                    fault = str(record[1] if isinstance(record, tuple) else record)
                    record = {"input": path, "result": "", "status": "failed", "fault": fault}
                keep(record)
                submit(itertools.islice(jobs, 1))


def _printable(text: object) -> str:
    """Returns foreign text for a terminal: question marks for control characters."""
    return "".join(c if c.isprintable() else "?" for c in str(text))


def _print_progress(done: int, all_inputs: int, record: dict[str, Any]) -> None:
    if record["status"] == "failed":
        path, fault = _printable(record["input"]), _printable(record["fault"])
        print(f"\rpenumbra: {fault if path in fault else f'{path}: {fault}'}", file=sys.stderr)
    if sys.stderr.isatty():
        bar = "#" * (40 * done // all_inputs)
        end = "\n" if done == all_inputs else ""
        print(f"\r[{bar:<40}] {done}/{all_inputs}", end=end, file=sys.stderr, flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m penumbra.batch",
        usage="%(prog)s INPUT... -o OUT [OPTION...] [-- OPTION of penumbra run...]",
        description="Judges many recordings and bags with `penumbra run`, on all cores or on a "
        "cluster of Dask's. What is done and unchanged is not done again.",
        epilog="Options after -- are those of `penumbra run`: -- --save labels. Exit status: 0; "
        "1 if an input failed; 2 if all failed or the arguments are wrong; 130 after Ctrl-C.",
        allow_abbrev=False,
    )
    parser.add_argument("inputs", nargs="*", metavar="INPUT",
                        help="recording, bag, 'pattern*.mcap', or list.txt: an input a line, "
                        "followed by options of its own")  # fmt: skip
    parser.add_argument("--calibrate", action="store_true",
                        help="run `penumbra calibrate` on episodes of one camera, and say whether "
                        "it moved between them; options after -- are its")  # fmt: skip
    add_options(parser)
    arguments = sys.argv[1:]
    end = arguments.index("--") if "--" in arguments else len(arguments)
    known, options = parser.parse_args(arguments[:end]), arguments[end + 1 :]

    def run_batch(where: dict[str, Any]) -> list[dict[str, Any]]:
        if not known.calibrate:
            return run(known.inputs, known.output, options, **where)
        records, poses = calibrate(known.inputs, known.output, options, **where)
        print("".join(f"{_printable(line)}\n" for line in camera_poses.lines(poses)), end="")
        return records

    return report(parser, known, run_batch)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds those of a batch of any work."""
    parser.add_argument("-o", "--output", required=True, help="folder for results and summary")
    parser.add_argument("--workers", type=int, help="processes here; default: one per core")
    parser.add_argument("--scheduler", help="tcp://HOST:PORT of a running cluster instead")
    parser.add_argument("--retry-failed", action="store_true", help="do failed inputs again")


def report(
    parser: argparse.ArgumentParser, known: argparse.Namespace,
    run_batch: Callable[[dict[str, Any]], list[dict[str, Any]]],
) -> int:  # fmt: skip
    """Runs a batch with the options of add_options, prints its course, returns the exit status."""
    if known.workers is not None and known.workers < 1:
        parser.error("--workers: 1 or more")
    try:
        records = run_batch({
            "workers": known.workers, "scheduler": known.scheduler,
            "retry_failed": known.retry_failed, "on_progress": _print_progress,
        })  # fmt: skip
    except InputError as error:
        print(f"penumbra: {_printable(error)}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    failed = sum(record["status"] == "failed" for record in records)
    summary = _printable(pathlib.Path(known.output, summary_name))
    print(f"{len(records) - failed} done, {failed} failed: {summary}")
    return 0 if failed == 0 else 2 if failed == len(records) else 1


if __name__ == "__main__":
    from penumbra import batch  # workers import it by this name

    sys.exit(batch.main())
