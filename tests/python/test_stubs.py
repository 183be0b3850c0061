# SPDX-License-Identifier: Apache-2.0
"""The type stubs that the build makes, and examples that keep to them."""

import ast
import pathlib
import subprocess
import sys

import pytest

import penumbra
from conftest import ROOT, only_in_full

PACKAGE = pathlib.Path(penumbra.__file__).parent


def test_the_stubs_next_to_the_module_name_its_public_classes():
    stubs = ast.parse((PACKAGE / "__init__.pyi").read_text())
    named = {node.name for node in stubs.body if isinstance(node, ast.ClassDef)}
    named |= {name.asname for node in stubs.body if isinstance(node, ast.ImportFrom)
              for name in node.names if node.level}
    public = {name for name, value in vars(penumbra).items() if isinstance(value, type) and not name.startswith("_")}
    assert "Session" in named and named == public | {"from_arrays"}
    assert (PACKAGE / "py.typed").exists()


@only_in_full
def test_mypy_finds_in_the_module_what_the_stubs_say():
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "penumbra",
                           "--ignore-missing-stub"], capture_output=True, text=True)
    # pybind11's classes have a metaclass of their own, and no signatures that Python could tell.
    expected = ("metaclass differs", "__init__ is inconsistent, stub does not have *args")
    found = [line for line in done.stdout.splitlines() if line.startswith("error:")]
    assert found, done.stdout + done.stderr
    assert not [line for line in found if not any(e in line for e in expected)]


@pytest.fixture(scope="module")
def mypy(tmp_path_factory):
    """Runs mypy; these tests share a cache. Returns what it printed."""
    pytest.importorskip("mypy")
    cache = tmp_path_factory.mktemp("mypy")
    return lambda *words, **options: subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, *words], capture_output=True, text=True,
        **options).stdout


def test_the_packages_own_python_is_typed(mypy):
    told = mypy("-p", "penumbra", cwd=PACKAGE.parent)
    assert "checked 10 source files" in told, told
    assert not [line for line in told.splitlines() if ".py:" in line], told


def test_examples_are_typed(mypy):
    scripts = sorted((ROOT / "examples" / "python").glob("*.py"))
    assert len(scripts) > 3
    told = mypy(*scripts)
    assert told.startswith("Success"), told


@only_in_full
def test_wrong_use_does_not_pass_mypy(mypy, tmp_path):
    script = tmp_path / "wrong.py"
    script.write_text("import penumbra\npenumbra.LabelRule(front_min_width='7')\npenumbra.Frame(None)\n")
    told = mypy(script)
    assert told.count("error:") == 2, told


def test_everything_is_documented():
    for name, value in vars(penumbra).items():
        if name.startswith("_") or isinstance(value, type(pathlib)) or name == "version":
            continue
        assert value.__doc__, name
        if not isinstance(value, type):
            continue
        for key, member in vars(value).items():
            if isinstance(member, property):
                assert member.__doc__, f"{name}.{key}"
