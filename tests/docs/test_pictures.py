# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/method.md are what its script draws, and every picture is small."""

import subprocess
import sys

import numpy as np
from PIL import Image

from blocks import ROOT

IMAGES = ROOT / "docs" / "images"
MOST_BYTES = 80_000
# Grey levels, mean: other builds of libjpeg decode otherwise, by less than one level.
SAME = 1.5


def test_pictures_are_what_the_script_draws(tmp_path):
    subprocess.run([sys.executable, ROOT / "scripts" / "method_pictures.py", tmp_path], check=True)
    drawn = sorted(tmp_path.iterdir())
    assert [file.name for file in drawn] == [file.name for file in sorted(IMAGES.glob("method-*"))]
    for file in drawn:
        now, shown = (np.asarray(Image.open(folder / file.name).convert("RGB"), float)
                      for folder in (tmp_path, IMAGES))
        assert now.shape == shown.shape
        assert np.abs(now - shown).mean() < SAME, f"{file.name}: run scripts/method_pictures.py"
        assert (IMAGES / file.name).stat().st_size < MOST_BYTES


def test_each_is_shown():
    page = (ROOT / "docs" / "method.md").read_text()
    for file in IMAGES.glob("method-*"):
        assert f"(images/{file.name})" in page, file.name
