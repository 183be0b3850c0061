# SPDX-License-Identifier: Apache-2.0
"""Point clouds without the robot: python3 filter_cloud.py RECORDING_OR_BAG OUT

Each frame becomes a PLY file of the points that are not the robot's, in the robot's root link, with
their colours. `penumbra run RECORDING_OR_BAG -o OUT --save points --points-frame LINK` does the same.
"""
import pathlib
import sys

import numpy as np

import penumbra

HEAD = """ply
format binary_little_endian 1.0
element vertex {}
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
end_header
"""

given = penumbra.open(sys.argv[1], color=True)
session = penumbra.Session(given.robot, given.camera, given.config)
for frame in given:
    report = session.process(frame)
    cloud = report.points(frame=given.robot.links[0], color=frame.color)
    vertices = np.zeros(len(cloud), [("point", "<f4", 3), ("color", "u1", 3)])
    vertices["point"] = cloud.points
    if len(cloud.colors):
        vertices["color"] = cloud.colors
    file = pathlib.Path(sys.argv[2]) / f"{report.index:06d}.ply"
    file.write_bytes(HEAD.format(len(cloud)).encode() + vertices.tobytes())
    print(f"{file}: {len(cloud)} points {report.message}")
