# SPDX-License-Identifier: Apache-2.0
"""The site has every page, and its reference every public name; scripts/docs.sh builds it."""

import re
import sys

import pytest

import penumbra
from blocks import ROOT

sys.path.insert(0, str(ROOT / "docs" / "site"))

import pages  # noqa: E402
import reference  # noqa: E402


def test_every_page_is_among_the_contents():
    listed = [name for names in pages.PAGES.values() for name in names]
    assert sorted(listed) == sorted(file.stem for file in (ROOT / "docs").glob("*.md"))


def test_every_page_is_linked_by_the_readme_or_a_page():
    texts = "".join(file.read_text() for file in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
    for file in (ROOT / "docs").glob("*.md"):
        assert re.search(rf"\]\((docs/)?{file.name}[)#]", texts), file.name


@pytest.fixture(scope="module")
def text():
    return reference.python_pages()


def test_the_reference_has_every_public_name(text):
    for name in reference.public(penumbra):
        assert re.search(rf"^\.\. py:(class|exception|function):: {name}\b", text, re.MULTILINE), name


def test_the_reference_has_every_member(text):
    for name, value in reference.public(penumbra).items():
        if not isinstance(value, type):
            continue
        start = re.search(rf"^\.\. py:(class|exception):: {name}\b", text, re.MULTILINE).start()
        end = re.search(r"^(\.\. py:|```)", text[start + 1:], re.MULTILINE).start()
        for member in vars(value):
            if not member.startswith("_"):
                assert re.search(rf"\b{member}\b", text[start:start + 1 + end]), f"{name}.{member}"


def test_signatures_are_short_and_whole(text):
    assert ".. py:method:: process(frame: Frame) -> FrameReport" in text
    assert ":type: uint8[H, W]" in text  # of labels
    assert "Annotated" not in text and "object at 0x" not in text
    assert "Default: ``Tolerance(a=0.015, b=0.0, c=0.006)``" in text


def test_every_header_of_the_reference_is_there():
    for headers in reference.HEADERS.values():
        for header in headers:
            assert (ROOT / "penumbra" / header).is_file(), header
