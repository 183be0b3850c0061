# SPDX-License-Identifier: Apache-2.0
"""Point clouds without the robot: python3 filter_cloud.py RECORDING_OR_BAG OUT

Each frame becomes a PLY file of the points that are not the robot's, in the robot's root link, with
their colours. Where the robot's pose is not known there are no points: they might be the robot's.
`penumbra run RECORDING_OR_BAG -o OUT --save points --points-frame LINK` does the same.
"""

import pathlib
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

import penumbra


def write_ply(path: pathlib.Path, points: NDArray[Any], colors: NDArray[Any]) -> None:
    vertices = np.empty(len(points), [("p", "<f4", 3), ("c", "u1", 3)])
    vertices["p"], vertices["c"] = points, colors
    names = [f"property float {c}" for c in "xyz"]
    names += [f"property uchar {c}" for c in ("red", "green", "blue")]
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}", *names]
    path.write_bytes("\n".join([*head, "end_header", ""]).encode() + vertices.tobytes())


def measured(depth: NDArray[Any]) -> NDArray[np.bool_]:
    """Where a depth image holds a distance: in 16 bits 0 and 65535 are none."""
    most = 65535 if depth.dtype == np.uint16 else np.inf
    return (depth > 0) & (depth < most)


def main(source: str, out: pathlib.Path) -> None:
    given = penumbra.open(source, color=True)
    session = penumbra.Session(given.robot, given.camera, given.config)
    for frame in given:
        report = session.process(frame)
        if frame.depth is None or report.T_root_camera is None:
            print(f"frame {report.index}: no points: {report.message}")
            continue
        color = np.full((*frame.depth.shape, 3), 255, np.uint8) if frame.color is None else frame.color
        cloud = report.points(frame=given.robot.links[0], color=color)
        write_ply(out / f"{report.index:06d}.ply", cloud.points, cloud.colors)
        robot = np.count_nonzero(measured(frame.depth)) - len(cloud)
        print(f"frame {report.index}: {len(cloud)} points, {robot} of the robot left out")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
