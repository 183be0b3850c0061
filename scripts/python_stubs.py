#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the type stubs of the module from its own signatures; the build calls it.

usage: PYTHONPATH=FOLDER_OF_THE_PACKAGE scripts/python_stubs.py OUT.pyi
"""

import enum
import inspect
import os
import re
import sys
from typing import Any, List, NamedTuple, Optional

WIDTH = 100
HEAD = '''# SPDX-License-Identifier: Apache-2.0
# Made by scripts/python_stubs.py from the module's own signatures.
import enum
import os
import pathlib
from typing import (
    Annotated,
    Callable,
    Dict,
    Iterable,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    Union,
    final,
    overload,
)

import numpy
from numpy import bool_, float32, float64, int32, uint8, uint16, uint32
from numpy.typing import ArrayLike, NDArray

from .recorder import Recorder as Recorder, from_arrays as from_arrays

__version__: str
version: str
'''
SHOWN = ("__init__", "__len__", "__getitem__", "__iter__", "__next__")


class Argument(NamedTuple):
    name: str
    type: str
    has_default: bool


class Signature(NamedTuple):
    arguments: List[Argument]
    result: str


def split(text: str, separator: str) -> List[str]:
    """Splits outside of brackets and quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for i, c in enumerate(text):
        if quote:
            quote = "" if c == quote and text[i - 1] != "\\" else quote
        elif c in "'\"":
            quote = c
        elif c in "([{<":
            depth += 1
        elif c in ")]}" or (c == ">" and text[i - 1] != "-"):
            depth -= 1
        elif depth == 0 and text.startswith(separator, i):
            parts.append(text[start:i])
            start = i + len(separator)
    return parts + [text[start:]]


def typed(text: str, is_argument: bool) -> str:
    text = text.strip().replace("penumbra.", "").replace("collections.abc.", "")
    # pybind11 3 says what it converts from.
    text = re.sub(r"typing\.Supports(Int|Float) \| typing\.SupportsIndex",
                  lambda of: of[1].lower(), text).replace("os.PathLike | str | bytes", "os.PathLike")
    if is_argument:
        text = text.replace("NDArray[float64]", "ArrayLike")
        text = re.sub(r"\b[Ll]ist\[", "Sequence[", text)  # pybind11 before 2.12 writes List
        return re.sub(r"\bos\.PathLike", "Union[str, os.PathLike[str]]", text)
    return re.sub(r"\bos\.PathLike", "pathlib.Path", text)


def argument(text: str) -> Argument:
    if text.strip().startswith("*"):
        return Argument(text.strip(), "", False)
    given = split(text, " = ")
    name, of = given[0].split(":", 1)
    return Argument(name.strip(), typed(of, True), len(given) > 1)


def signature(line: str) -> Signature:
    start = line.index("(")
    depth = 0
    for end in range(start, len(line)):
        depth += {"(": 1, ")": -1}.get(line[end], 0)
        if depth == 0 and line[end + 1 :].startswith(" -> "):
            break
    parts = split(line[start + 1 : end], ", ") if end > start + 1 else []
    return Signature([argument(part) for part in parts], typed(line[end + 5 :], False))


def signatures(doc: str, name: str) -> List[Signature]:
    doc = re.sub(r"\n +", " ", doc)  # arrays among the defaults have several lines
    pattern = rf"^(?:\d+\. )?{re.escape(name)}\((?!\*args, \*\*kwargs\)$).*\) -> .*$"
    return [signature(line) for line in re.findall(pattern, doc, re.MULTILINE)]


def declared(a: Argument) -> str:
    if not a.type:
        return a.name
    return f"{a.name}: {a.type}" + (" = ..." if a.has_default else "")


def function(name: str, s: Signature, indent: str, decorators: List[str]) -> str:
    lines = [indent + decorator for decorator in decorators]
    arguments = [declared(a) for a in s.arguments]
    if indent and "@staticmethod" not in decorators:
        arguments[0] = "self"
    line = f"{indent}def {name}({', '.join(arguments)}) -> {s.result}: ..."
    if len(line) > WIDTH:
        inner = "".join(f"{indent}    {a},\n" for a in arguments)
        line = f"{indent}def {name}(\n{inner}{indent}) -> {s.result}: ..."
    return "\n".join(lines + [line]) + "\n"


def functions(name: str, doc: str, indent: str, decorators: List[str]) -> str:
    found = signatures(doc, name)
    assert found, f"{name} tells no signature: {doc!r}"
    overloads = ["@overload"] if len(found) > 1 else []
    return "".join(function(name, s, indent, overloads + decorators) for s in found)


def replace(of: type) -> str:
    made = signatures(of.__init__.__doc__ or "", "__init__")[0]
    changes = [a._replace(has_default=True) for a in made.arguments[1:] if a.type]
    keyword = [made.arguments[0], Argument("*", "", False), *changes]
    return function("replace", Signature(keyword, of.__name__), "    ", [])


def member(of: type, name: str, value: Any) -> Optional[str]:
    if isinstance(value, property):
        result = signatures("get" + (value.fget.__doc__ or ""), "get")[0].result
        return f"    @property\n    def {name}(self) -> {result}: ...\n"
    if name == "replace":
        return replace(of)
    doc = getattr(of, name).__doc__ or ""
    if name.startswith("_") and (name not in SHOWN or doc.startswith("Initialize self")):
        return None
    decorators = ["@staticmethod"] if isinstance(value, staticmethod) else []
    return functions(name, doc, "    ", decorators)


def described(of: type) -> str:
    if issubclass(of, enum.Enum):
        base = "enum.IntEnum" if issubclass(of, enum.IntEnum) else "enum.Enum"
        members = "".join(f"    {m.name} = {m.value!r}\n" for m in of)
        return f"class {of.__name__}({base}):\n{members}".replace("'", '"')
    if issubclass(of, Exception):
        return f"class {of.__name__}({of.__bases__[0].__name__}): ...\n"
    members = [member(of, name, value) for name, value in vars(of).items()]
    body = "".join(m for m in members if m) or "    ...\n"
    return f"@final\nclass {of.__name__}:\n{body}"


def stubs(module: Any, exported: List[str]) -> str:
    text = HEAD + f"__all__ = {exported}\n"
    for name, value in vars(module).items():
        if name.startswith("_") or name == "version":
            continue
        if inspect.isclass(value):
            text += "\n" + described(value)
        else:
            text += "\n" + functions(name, value.__doc__ or "", "", [])
    return text


if __name__ == "__main__":
    import penumbra._core

    part = sys.argv[1] + ".part"  # takes its name when it is whole
    with open(part, "w", encoding="utf-8") as out:
        out.write(stubs(penumbra._core, penumbra.__all__))
    os.replace(part, sys.argv[1])
