# SPDX-License-Identifier: Apache-2.0
"""The site has every page, and its reference every public name; scripts/docs.sh builds it. The pictures
of docs/method.md are what its script draws, and every picture is small."""

import re
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import penumbra
from blocks import ROOT

sys.path.insert(0, str(ROOT / "docs" / "site"))

import pages  # noqa: E402
import reference  # noqa: E402


def test_every_page_is_among_the_contents_and_linked_by_the_readme_or_a_page():
    listed = [name for names in pages.PAGES.values() for name in names]
    assert sorted(listed) == sorted(file.stem for file in (ROOT / "docs").glob("*.md"))
    texts = "".join(file.read_text() for file in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
    for file in (ROOT / "docs").glob("*.md"):
        assert re.search(rf"\]\((docs/)?{file.name}[)#]", texts), file.name


@pytest.fixture(scope="module")
def text():
    return reference.python_pages()


def test_the_reference_has_every_public_name_and_member(text):
    for name, value in reference.public(penumbra).items():
        found = re.search(rf"^\.\. py:(class|exception|function):: {name}\b", text, re.MULTILINE)
        assert found, name
        if isinstance(value, type):
            own = re.split(r"^(?:\.\. py:|```)", text[found.end():], 1, re.MULTILINE)[0]
            for member in vars(value):
                assert member.startswith("_") or re.search(rf"\b{member}\b", own), f"{name}.{member}"


def test_every_header_of_the_reference_is_there():
    for headers in reference.HEADERS.values():
        for header in headers:
            assert (ROOT / "penumbra" / header).is_file(), header


IMAGES = ROOT / "docs" / "images"
MOST_BYTES = 80_000
# Grey levels, mean: other builds of libjpeg decode otherwise, by less than one level.
SAME = 1.5


def test_pictures_are_what_the_script_draws(tmp_path):
    subprocess.run([sys.executable, ROOT / "scripts" / "method_pictures.py", tmp_path], check=True)
    drawn, page = sorted(tmp_path.iterdir()), (ROOT / "docs" / "method.md").read_text()
    assert [file.name for file in drawn] == [file.name for file in sorted(IMAGES.glob("method-*"))]
    for file in drawn:
        now, shown = (np.asarray(Image.open(folder / file.name).convert("RGB"), float)
                      for folder in (tmp_path, IMAGES))
        assert now.shape == shown.shape
        assert np.abs(now - shown).mean() < SAME, f"{file.name}: run scripts/method_pictures.py"
        assert (IMAGES / file.name).stat().st_size < MOST_BYTES
        assert f"(images/{file.name})" in page
