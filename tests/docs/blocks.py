# SPDX-License-Identifier: Apache-2.0
"""What the documents show: their fenced blocks, and the commands in them."""

import pathlib
import re
import shlex
from typing import List, NamedTuple

ROOT = pathlib.Path(__file__).parents[2]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md"),
                    *(ROOT / "examples").glob("*/README.md"), ROOT / "research" / "README.md"])


class Block(NamedTuple):
    document: str  # relative to the root
    line: int      # of its first line
    language: str  # "": a shell's
    text: str

    def __str__(self):
        return f"{self.document}:{self.line}"


class Command(NamedTuple):
    words: List[str]
    text: str
    line: int


def blocks_of(document: pathlib.Path) -> List[Block]:
    blocks, start, language, lines = [], 0, "", []
    for number, line in enumerate(document.read_text().splitlines(), 1):
        fence = re.match(r"^\s*```(\w*)\s*$", line)
        assert fence or "```" not in line, f"{document}:{number}: which language is this?"
        if fence and not start:
            start, language, lines = number + 1, fence[1], []
        elif fence:
            blocks.append(Block(str(document.relative_to(ROOT)), start, language, "\n".join(lines)))
            start = 0
        elif start:
            lines.append(line)
    assert not start, f"{document}:{start}: is not closed"
    return blocks


def all_blocks(*languages: str) -> List[Block]:
    return [block for document in DOCUMENTS for block in blocks_of(document) if block.language in languages]


# What the first lines of these take.
GIVEN = """
import penumbra
given = penumbra.open("examples/arm_over_table")
robot, camera = str(given.robot.urdf), given.camera
depth, joints = given[4].depth, dict(zip(given.robot.variables, given[4].pose.positions))
"""
BEFORE = {"README.md": GIVEN, "python.md": GIVEN}


def program_of(document: pathlib.Path) -> str:
    """A document's blocks in their order, as one program."""
    blocks = [block.text for block in blocks_of(document) if block.language == "python"]
    return "\n".join([BEFORE.get(document.name, ""), *blocks])


def commands_of(block: Block) -> List[Command]:
    """Lines of a shell: those that end in a backslash go on, && parts commands, # begins a comment."""
    commands, pending, first = [], "", 0
    for number, line in enumerate(block.text.splitlines(), block.line):
        first = first if pending else number
        pending += re.sub(r"(^|\s)#.*$", "", line)
        if pending.endswith("\\"):
            pending = pending[:-1] + " "
            continue
        for text in pending.split("&&"):
            if text.strip():
                commands.append(Command(shlex.split(text), " ".join(text.split()), first))
        pending = ""
    assert not pending, f"{block}: ends in a backslash"
    return commands


def inline_code() -> List[NamedTuple]:
    """(document, text) of every `text` outside of blocks."""
    found = []
    for document in DOCUMENTS:
        text = re.sub(r"^\s*```.*?^\s*```", "", document.read_text(), flags=re.MULTILINE | re.DOTALL)
        found += [(str(document.relative_to(ROOT)), code) for code in re.findall(r"`([^`]+)`", text)]
    return found
