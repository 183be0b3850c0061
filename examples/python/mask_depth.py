# SPDX-License-Identifier: Apache-2.0
"""Depth images and points without the robot: python3 mask_depth.py RECORDING_OR_BAG OUT"""
import pathlib
import sys

import numpy as np

import penumbra

source = penumbra.open(sys.argv[1])
session = penumbra.Session(source.robot, source.camera, source.config)
for frame in source:
    report = session.process(frame)
    out = pathlib.Path(sys.argv[2]) / f"{frame.index:06d}"
    np.save(f"{out}.npy", report.without_robot())
    np.save(f"{out}_points.npy", report.points(frame=source.robot.links[0]).points)
