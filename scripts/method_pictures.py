#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/method.md: one frame of the shipped recording, step by step.

usage: PYTHONPATH=build/release/python scripts/method_pictures.py [FOLDER]   (docs/images)
"""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np
from PIL import Image

import penumbra

ROOT = pathlib.Path(__file__).parents[1]
FRAME = 6            # the hand is in front of the arm, and the arm in front of the cube
RANGE = (0.8, 2.4)   # metres, of the depth images' colours
MOST = 0.1           # metres, of the difference's colours
NO_DEPTH, NO_DIFFERENCE = (0, 0, 0), (215, 215, 215)
JPEG_QUALITY = 85
# Okabe and Ito's, as in overlays: clear, front, occluded, unknown, beyond, fringe.
LABELS = np.array([(255, 255, 255), (0, 114, 178), (213, 94, 0), (240, 228, 66), (204, 121, 167),
                   (0, 158, 115)], np.uint8)


def coloured(values, low, high, name, nothing, blank=NO_DEPTH):
    """By a colour map, with `blank` where there is no value."""
    shares = np.clip((values - low) / (high - low), 0, 1)
    image = (255 * matplotlib.colormaps[name](shares)[..., :3]).astype(np.uint8)
    image[nothing] = blank
    return image


def judged():
    """The frame, copies of its measured and virtual depth in metres, and of its labels."""
    given = penumbra.open(ROOT / "examples" / "arm_over_table", color=True)
    session = penumbra.Session(given.robot, given.camera, given.config)
    frame = next(frame for frame in given if frame.index == FRAME)
    report = session.process(frame)
    return frame, frame.depth / 1000, report.virtual_depth.copy(), report.labels.copy()


def overlay():
    """What `penumbra run --save overlay` draws."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "penumbra", "run", ROOT / "examples" / "arm_over_table", "-o",
                        folder, "--frames", f"0:{FRAME + 1}", "--save", "overlay"], check=True,
                       capture_output=True)
        return np.asarray(Image.open(pathlib.Path(folder) / "overlay" / f"{FRAME:06d}.png"))


def pictures():
    frame, measured, virtual, labels = judged()
    robot, seen = virtual > 0, measured > 0
    hidden = (labels != penumbra.Label.clear) & (labels != penumbra.Label.front)
    without = np.where(hidden, 0, measured)
    return {
        "color": frame.color,
        "depth": coloured(measured, *RANGE, "viridis_r", ~seen),
        "virtual": coloured(virtual, *RANGE, "viridis_r", ~robot),
        "difference": coloured(measured - virtual, -MOST, MOST, "RdBu_r", ~(robot & seen),
                               NO_DIFFERENCE),
        "labels": LABELS[labels],
        "without": coloured(without, *RANGE, "viridis_r", without == 0),
        "overlay": overlay(),
    }


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, image in pictures().items():
        picture = Image.fromarray(np.ascontiguousarray(image))
        if name == "labels":
            picture.quantize(len(LABELS)).save(folder / f"method-{name}.png", optimize=True)
        else:
            picture.save(folder / f"method-{name}.jpg", quality=JPEG_QUALITY)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images")
