# SPDX-License-Identifier: Apache-2.0
"""A folder of recordings and bags on all cores: python3 batch_folder.py FOLDER OUT

Writes the depth images without the robot. Threads are enough: other Python threads run while frames
are read and judged. Each thread has a session of its own.
"""
import pathlib
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import penumbra

FOLDER, OUT = map(pathlib.Path, sys.argv[1:])


def judge(source: pathlib.Path) -> bool:
    try:
        given = penumbra.open(source)
        session = penumbra.Session(given.robot, given.camera, given.config)
        out = OUT / source.relative_to(FOLDER)
        out.mkdir(parents=True, exist_ok=True)
        for frame in given:
            report = session.process(frame)
            np.savez_compressed(out / f"{report.index:06d}.npz", depth=report.without_robot())
    except penumbra.InputError as error:  # names the file and what would be right
        print(error, file=sys.stderr)
        return False
    print(f"{source}: done")
    return True


sources = [file.parent for file in FOLDER.rglob("recording.yaml")]
sources += [*FOLDER.rglob("*.mcap"), *FOLDER.rglob("*.db3")]
with ThreadPoolExecutor() as threads:
    done = sum(threads.map(judge, sources))
print(f"{done} of {len(sources)} judged")
sys.exit(0 if done == len(sources) else 2)
