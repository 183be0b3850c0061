#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/cloud.png: a frame's points from above, all of them and without the robot.

    scripts/cloud_picture.py [RECORDING [FRAME [PNG]]]    default: the shipped recording

Needs the penumbra module in PYTHONPATH, python3-numpy and python3-pil.
"""
import pathlib
import sys

import numpy as np
from PIL import Image

import penumbra

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = (480, 380)  # of each half
TURN = np.deg2rad([-16.0, 20.0])  # of the view about x and y, around the middle of the scene
ZOOM, DISTANCE = 1.15, 1.25  # of the view: focal length in widths, distance in median depths
BACKGROUND = 24


def rotation(x, y):
    about_x = np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
    about_y = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    return about_x @ about_y


def draw(points, colors, middle):
    seen = (points - middle) @ rotation(*TURN).T + [0, 0, DISTANCE * middle[2]]
    order = np.argsort(-seen[:, 2])
    seen, colors = seen[order], colors[order]
    scale = ZOOM * SIZE[0] / seen[:, 2]
    u = (seen[:, 0] * scale + SIZE[0] / 2).astype(int)
    v = (seen[:, 1] * scale + SIZE[1] / 2).astype(int)
    image = np.full((SIZE[1], SIZE[0], 3), BACKGROUND, np.uint8)
    for du, dv in ((0, 0), (1, 0), (0, 1), (1, 1)):
        inside = (u + du >= 0) & (u + du < SIZE[0]) & (v + dv >= 0) & (v + dv < SIZE[1])
        image[v[inside] + dv, u[inside] + du] = colors[inside]
    return image


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else ROOT / "examples/arm_over_table"
    wanted = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    png = sys.argv[3] if len(sys.argv) > 3 else ROOT / "docs/images/cloud.png"
    source = penumbra.open(folder, color=True)
    session = penumbra.Session(source.robot, source.camera, source.config)
    for frame in source:
        report = session.process(frame)
        if frame.index != wanted:
            continue
        cloud = report.points(color=frame.color)
        k = source.camera.intrinsics
        v, u = np.nonzero(frame.depth)
        z = frame.depth[v, u] / 1000.0
        everything = np.stack([(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z], axis=1)
        middle = np.median(everything, axis=0)
        halves = [draw(everything, frame.color[v, u], middle),
                  draw(cloud.points, cloud.colors, middle)]
        gap = np.full((SIZE[1], 8, 3), 255, np.uint8)
        Image.fromarray(np.hstack([halves[0], gap, halves[1]])).save(png)
        print(f"{png}: {len(everything)} points, {len(cloud)} without the robot")


main()
