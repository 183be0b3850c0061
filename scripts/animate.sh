#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the animated pictures (APNG) of docs/images: arm_over_table.png from the shipped recording, and
# conveyor.png and handover.png from the experiments' first seed.
#   scripts/animate.sh [NAME...]     default: all three
# Needs python3-pil, python3-yaml, fonts-dejavu-core and, in build/release, penumbra and penumbra_research.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
program=${PENUMBRA:-$root/build/release/apps/penumbra/penumbra}
research=${RESEARCH:-$root/build/release/research/penumbra_research}

# animate FOLDER TARGET: one picture of the folder's PNGs.
animate() {
  "${PYTHON:-/usr/bin/python3}" - "$1" "$2" <<'PYTHON'
import json
import pathlib
import sys

from PIL import Image, ImageDraw, ImageFont

VERDICTS = {"visible": (0, 158, 115), "partial": (230, 159, 0), "hidden": (213, 94, 0),
            "unknown": (240, 228, 66), "out_of_view": (153, 153, 153)}
source, target = map(pathlib.Path, sys.argv[1:])


def captioned(image, results):
    """The part of the image where things happen, and the verdicts below it in letters for a phone."""
    image = image.convert("RGB").crop((204, 76, 640, 332)).resize((654, 384), Image.LANCZOS)
    whole = Image.new("RGB", (654, 456), (24, 24, 24))
    whole.paste(image)
    draw, font = ImageDraw.Draw(whole), ImageFont.truetype("DejaVuSans-Bold.ttf", 24)
    for row, result in enumerate(results):
        verdict, name, y = result["verdict"], result["name"], 388 + 33 * row
        by = ""
        if verdict in ("hidden", "partial"):
            is_robot = result["occluded_fraction"] > result["hidden_by_other_fraction"]
            by = " by " + (result["blame"][0]["link"] if is_robot else "something else")
        is_held = verdict != "out_of_view" and (result["handled"] or {}).get("source") == "held"
        held = ", point held" if is_held else ""
        draw.rectangle((14, y + 4, 34, y + 24), fill=VERDICTS[verdict])
        draw.text((46, y), f"{name}: {verdict.replace('_', ' ')}{by}{held}", (255, 255, 255), font)
    return whole


files = sorted(source.glob("*.png"))
report = source.parent / "report.json"
if report.exists():  # of penumbra run: all frames
    frames = [captioned(Image.open(file), frame["targets"])
              for file, frame in zip(files, json.loads(report.read_text())["frames"])]
    milliseconds, colours = [700] * (len(frames) - 1) + [1500], 224
else:  # of an experiment: every third frame at two thirds of its size
    frames = [Image.open(file) for file in files[::3]]
    frames = [f.resize((400, f.height * 400 // f.width), Image.LANCZOS) for f in frames]
    milliseconds, colours = 100, 96
# In few colours that all frames share.
width, height = frames[0].size
sheet = Image.new("RGB", (width, height * 4))
for i in range(4):
    sheet.paste(frames[i * (len(frames) - 1) // 3], (0, i * height))
for i, colour in enumerate(VERDICTS.values()):
    sheet.paste(colour, (60 * i, 0, 60 * i + 60, 60))
palette = sheet.quantize(colours)
entries = palette.getpalette()[:3 * colours]
palette.putpalette(entries + entries[-3:] * (256 - colours))  # else Pillow adds black, and drops it
few = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
few[0].save(target, format="PNG", save_all=True, append_images=few[1:], duration=milliseconds,
            loop=0)
print(target, target.stat().st_size // 1024, "kB")
PYTHON
}

for name in "${@:-arm_over_table conveyor handover}"; do
  for picture in $name; do
    if [ "$picture" = arm_over_table ]; then
      # The lid and the hand alone: the labels of all four targets lie on each other.
      "${PYTHON:-/usr/bin/python3}" - "$root/examples/$picture" >"$work/targets.yaml" <<'PYTHON'
import pathlib
import sys

import yaml

folder = pathlib.Path(sys.argv[1])
targets = yaml.safe_load((folder / "targets.yaml").read_text())["targets"]
targets = [target for target in targets if target["name"] in ("lid", "wrist")]
targets[1]["name"] = "hand"  # whose wrist it is
targets[1]["keypoint"]["csv"] = str(folder / "wrist.csv")
print(yaml.safe_dump({"targets": targets}, sort_keys=False))
PYTHON
      "$program" run "$root/examples/$picture" -o "$work/$picture" --save overlay \
        --targets "$work/targets.yaml" >/dev/null
      animate "$work/$picture/overlay" "$root/docs/images/$picture.png"
    else
      "$research" "$picture" --seeds 0:1 --frames -o "$work/$picture" >/dev/null
      animate "$work/$picture/frames" "$root/docs/images/$picture.png"
    fi
  done
done
