# SPDX-License-Identifier: Apache-2.0
"""A folder of recordings and bags on all cores: python3 batch_folder.py FOLDER OUT

Writes what is not the robot of every depth image, and says how many pixels were. Threads are
enough: Python runs on while frames are read and judged. Each thread has a session of its own.
"""

import os
import pathlib
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import List

import numpy as np

import penumbra


def inputs_in(folder: pathlib.Path) -> List[pathlib.Path]:
    recordings = [file.parent for file in folder.rglob("recording.yaml")]
    return sorted(recordings + list(folder.rglob("*.mcap")) + list(folder.rglob("*.db3")))


def judge(source: pathlib.Path, out: pathlib.Path) -> str:
    given = penumbra.open(source)
    session = penumbra.Session(given.robot, given.camera, given.config)
    frames = robot = 0
    for frame in given:
        report = session.process(frame)
        if frame.depth is None or report.pixels.robot is None:
            print(f"{source}: frame {report.index}: {report.message}", file=sys.stderr)
            continue
        is_robot = (report.labels != penumbra.Label.clear) & (report.labels != penumbra.Label.front)
        np.savez_compressed(out / f"{report.index:06d}.npz", depth=np.where(is_robot, 0, frame.depth))
        frames += 1
        robot += report.pixels.robot
    return f"{frames} frames, {robot // max(frames, 1)} robot pixels in each"


def try_to_judge(source: pathlib.Path, out: pathlib.Path) -> bool:
    out.mkdir(parents=True, exist_ok=True)
    try:
        print(f"{source}: {judge(source, out)}")
    except penumbra.InputError as error:  # names the file and what would be right
        print(error, file=sys.stderr)
        return False
    return True


def main(folder: pathlib.Path, out: pathlib.Path) -> int:
    sources = inputs_in(folder)
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        done = threads.map(lambda i: try_to_judge(sources[i], out / str(i)), range(len(sources)))
        failed = list(done).count(False)
    print(f"{len(sources) - failed} of {len(sources)} judged")
    return 2 if failed else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
