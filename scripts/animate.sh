#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/images/conveyor.png and handover.png, animated (APNG), from the experiments' first seed.
#   scripts/animate.sh [PROGRAM]     PROGRAM: default build/release/research/penumbra_research
# Needs python3-pil.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
program=${1:-$root/build/release/research/penumbra_research}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for experiment in conveyor handover; do
  "$program" "$experiment" --seeds 0:1 --frames -o "$work/$experiment" >/dev/null
  "${PYTHON:-/usr/bin/python3}" - "$work/$experiment/frames" "$root/docs/images/$experiment.png" <<'PYTHON'
import pathlib
import sys

from PIL import Image

# Every third frame at two thirds of its size, in 96 colours that all frames share.
EVERY, COLOURS, WIDTH, MILLISECONDS = 3, 96, 400, 100
source, target = map(pathlib.Path, sys.argv[1:])
files = sorted(source.glob("*.png"))[::EVERY]
frames = []
for file in files:
    image = Image.open(file)
    frames.append(image.resize((WIDTH, image.height * WIDTH // image.width), Image.LANCZOS))
sheet = Image.new("RGB", (WIDTH, frames[0].height * 4))
for i in range(4):
    sheet.paste(frames[i * (len(frames) - 1) // 3], (0, i * frames[0].height))
for i, colour in enumerate([(213, 94, 0), (0, 158, 115)]):  # of the boxes
    sheet.paste(colour, (60 * i, 0, 60 * i + 60, 60))
palette = sheet.quantize(COLOURS)
entries = palette.getpalette()[:3 * COLOURS]
palette.putpalette(entries + entries[-3:] * (256 - COLOURS))  # else Pillow adds black, and drops it
few = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
few[0].save(target, format="PNG", save_all=True, append_images=few[1:], duration=MILLISECONDS,
            loop=0)
print(target, target.stat().st_size // 1024, "kB")
PYTHON
done
