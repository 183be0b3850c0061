# SPDX-License-Identifier: Apache-2.0
"""Depth images without the robot: python3 mask_depth.py RECORDING_OR_BAG OUT"""
import pathlib
import sys

import numpy as np

import penumbra

source = penumbra.open_input(sys.argv[1])
pipeline = penumbra.Pipeline(source.robot, source.camera, source.config)
for frame in source:
    report = pipeline.process(frame.frame)
    is_robot = (report.labels != penumbra.Label.clear) & (report.labels != penumbra.Label.front)
    if frame.depth is not None:
        masked = np.where(is_robot, 0, frame.depth)
        np.save(pathlib.Path(sys.argv[2]) / f"{frame.index:06d}.npy", masked)
