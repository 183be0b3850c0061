#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/robot_masks.jpg: links and prompts of a frame of the shipped recording.

Needs the penumbra module in PYTHONPATH, python3-numpy and python3-pil.
"""
import colorsys
import pathlib

import numpy as np
from PIL import Image, ImageDraw

import penumbra
from penumbra import mask_files

ROOT = pathlib.Path(__file__).resolve().parent.parent
FRAME = 0
CROP = (110, 30, 590, 430)


def main():
    source = penumbra.open(ROOT / "examples/arm_over_table", color=True)
    session = penumbra.Session(source.robot, source.camera, source.config)
    frame = next(frame for frame in source if frame.index == FRAME)
    report = session.process(penumbra.Frame(None, frame.pose.positions))
    links, names = report.link_image.astype(np.uint8), report.links
    colors = np.array([[0, 0, 0], *(colorsys.hsv_to_rgb(i / len(names), 0.8, 1)
                                    for i in range(len(names)))]) * 255
    mixed = np.where(links[..., None] > 0, 0.3 * frame.color + 0.7 * colors[links], frame.color)
    masks = Image.fromarray(mixed.astype(np.uint8))
    prompts = Image.fromarray(frame.color)
    draw = ImageDraw.Draw(prompts)
    for value, prompt in mask_files.prompts(links).items():
        color = tuple(colors[value].astype(int))
        draw.rectangle(prompt["box"], outline=color, width=2)
        for u, v in prompt["points"]:
            draw.ellipse((u - 4, v - 4, u + 4, v + 4), fill=color, outline="black")
    both = Image.new("RGB", (2 * (CROP[2] - CROP[0]) + 8, CROP[3] - CROP[1]), "white")
    both.paste(masks.crop(CROP), (0, 0))
    both.paste(prompts.crop(CROP), (CROP[2] - CROP[0] + 8, 0))
    both.save(ROOT / "docs/images/robot_masks.jpg", quality=85)


main()
