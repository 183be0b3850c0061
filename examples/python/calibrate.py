# SPDX-License-Identifier: Apache-2.0
"""Finds the camera's pose from the robot that it sees: python3 calibrate.py INPUT POSE.csv

Refuses, with exit status 2, a pose that must not be used.
"""

import pathlib
import sys

import numpy as np

import penumbra


def main(source: pathlib.Path, out: pathlib.Path) -> int:
    given = penumbra.open(source)
    found = penumbra.calibrate(given, given.camera, given.robot)
    for line in [*found.notes, *found.faults]:
        print(line, file=sys.stderr)
    if not found.is_good:
        return 2
    print(f"position within {1000 * found.position_error:.1f} mm, "
          f"rotation within {np.degrees(found.rotation_error):.2f} degrees (95 %)")
    np.savetxt(out, found.T_parent_camera, delimiter=",")
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
