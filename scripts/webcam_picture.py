#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/webcam.jpg: the arm drawn into the image of a webcam with a strong lens.

Red: its outline if the lens were left out. The colour image is that of the shipped recording, bent by the lens. Needs the penumbra module in
PYTHONPATH, python3-numpy and python3-pil.
"""
import pathlib

import numpy as np
from PIL import Image

import penumbra

ROOT = pathlib.Path(__file__).resolve().parent.parent
FRAME = 6
SIZE = (640, 480)
K1, K2 = -0.36, 0.09
FOCAL = 720.0  # the corners just lie inside the recording's image
SCALE = 2      # so that the outline is as thin as a pixel of the camera
TINT, OUTLINE, PINHOLE = (30, 220, 120), (255, 255, 255), (255, 40, 40)


def distorted(x, y):
    r2 = x * x + y * y
    return (1 + K1 * r2 + K2 * r2 * r2) * np.array([x, y])


def bent(color, k):
    """Returns the colour image (H, W, 3) as the lens shows it; bilinear."""
    v, u = np.mgrid[:SIZE[1], :SIZE[0]]
    target = np.array([(u - (SIZE[0] - 1) / 2) / FOCAL, (v - (SIZE[1] - 1) / 2) / FOCAL])
    at = target.copy()
    for _ in range(50):  # a fixed point, which strong lenses reach slowly
        at += target - distorted(*at)
    u, v = k.fx * at[0] + k.cx, k.fy * at[1] + k.cy
    assert u.min() >= 0 and v.min() >= 0 and u.max() < k.width - 1 and v.max() < k.height - 1
    i, j = u.astype(int), v.astype(int)
    a, b = (u - i)[..., None], (v - j)[..., None]
    c = color.astype(float)
    return ((1 - b) * ((1 - a) * c[j, i] + a * c[j, i + 1])
            + b * ((1 - a) * c[j + 1, i] + a * c[j + 1, i + 1]))


def outline(mask):
    edge = np.zeros_like(mask)
    for axis in (0, 1):
        edge |= mask & ~(np.roll(mask, 1, axis) & np.roll(mask, -1, axis))
    return edge


def main():
    source = penumbra.open(ROOT / "examples/arm_over_table", color=True)
    frame = next(frame for frame in source if frame.index == FRAME)
    seen = source.camera

    def mask(distortion):
        camera = penumbra.Camera(
            penumbra.Intrinsics(*SIZE, FOCAL, FOCAL, (SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2),
            distortion=distortion, parent=seen.parent, T_parent_camera=seen.T_parent_camera)
        robot = penumbra.robot_mask(source.robot, camera, frame.pose)
        return robot.repeat(SCALE, 0).repeat(SCALE, 1)

    robot = mask(penumbra.Distortion("plumb_bob", [K1, K2, 0, 0, 0]))
    image = Image.fromarray(bent(frame.color, seen.intrinsics).astype(np.uint8))
    image = np.asarray(image.resize((SCALE * SIZE[0], SCALE * SIZE[1]), Image.BICUBIC)).astype(float)
    image[robot] = 0.62 * image[robot] + 0.38 * np.array(TINT)
    image[outline(mask(penumbra.Distortion()))] = PINHOLE
    image[outline(robot)] = OUTLINE
    Image.fromarray(image.astype(np.uint8)).save(ROOT / "docs/images/webcam.jpg", quality=82)


main()
