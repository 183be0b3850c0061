# SPDX-License-Identifier: Apache-2.0
"""The type stubs that the build makes, and examples that keep to them. A wheel, made and installed in a
virtual environment without the net, brings its libraries along."""

import ast
import os
import pathlib
import re
import subprocess
import sys

import pytest

import penumbra
from conftest import execute, only_in_full, ROOT, run_python, SHIPPED

PACKAGE = pathlib.Path(penumbra.__file__).parent


def test_the_stubs_next_to_the_module_name_its_public_classes():
    stubs = ast.parse((PACKAGE / "__init__.pyi").read_text())
    named = {node.name for node in stubs.body if isinstance(node, ast.ClassDef)}
    named |= {name.asname for node in stubs.body if isinstance(node, ast.ImportFrom)
              for name in node.names if node.level}
    public = {name for name, value in vars(penumbra).items() if isinstance(value, type) and not name.startswith("_")}
    assert "Session" in named and named == public | {"from_arrays"}
    assert (PACKAGE / "py.typed").exists()


def test_a_star_import_brings_what_the_stubs_name_and_keeps_the_builtin_open():
    found = {}
    exec("from penumbra import *", found)
    stubs = (PACKAGE / "__init__.pyi").read_text()
    named = ast.literal_eval(re.search(r"^__all__ = (.*)", stubs, re.MULTILINE)[1])
    assert set(named) == set(found) - {"__builtins__"} and "open" not in named
    assert {"Session", "Recorder", "from_arrays", "robot_mask"} < set(named)


def test_the_packages_own_python_and_the_examples_are_typed(tmp_path):
    pytest.importorskip("mypy")

    def mypy(*words, **options):
        command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, *words]
        return subprocess.run(command, capture_output=True, text=True, **options).stdout

    told = mypy("-p", "penumbra", cwd=PACKAGE.parent)
    assert "checked 10 source files" in told, told
    assert not [line for line in told.splitlines() if ".py:" in line], told
    scripts = sorted((ROOT / "examples" / "python").glob("*.py"))
    assert len(scripts) > 3
    told = mypy(*scripts)
    assert told.startswith("Success"), told


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


def test_a_module_for_numpy_1_refuses_numpy_2(tmp_path):
    (tmp_path / "numpy").mkdir()
    (tmp_path / "numpy" / "__init__.py").write_text("__version__ = '2.0.0'")
    path = os.pathsep.join([str(tmp_path), str(PACKAGE.parent)])
    told = run_python("-c", "import penumbra", env={**os.environ, "PYTHONPATH": path}, status=1).stderr
    if "No module named 'numpy.lib'" in told:
        pytest.skip("made with pybind11 2.12 or newer, which asks more of NumPy 2")
    assert "ImportError: " in told and "NumPy 2.0.0" in told and 'take "numpy<2"' in told, told


CHECK = """
import pathlib, sys, penumbra
assert sys.prefix in penumbra.__file__, penumbra.__file__
package = pathlib.Path(penumbra.__file__).parent
assert (package / "__init__.pyi").exists() and (package / "py.typed").exists()
given = penumbra.open(sys.argv[1])
session = penumbra.Session(given.robot, given.camera, given.config)
print(sum(session.process(frame).pixels.robot for frame in given))
"""


@only_in_full
def test_the_wheel_is_built_offline_and_works(tmp_path):
    clean = {key: value for key, value in os.environ.items()
             if key not in ("PYTHONPATH", "PIP_INDEX_URL", "PYTHONDONTWRITEBYTECODE")}
    clean.update(PIP_NO_INDEX="1", PIP_DISABLE_PIP_VERSION_CHECK="1")

    def step(*command):
        return execute(*command, env=clean, cwd=tmp_path).stdout

    step(sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    step(ROOT / "scripts" / "wheel.sh", python)
    wheels = sorted((ROOT / "build" / "wheel").glob("penumbra-*manylinux*.whl"), key=os.path.getmtime)
    step(python, "-m", "pip", "install", wheels[-1])
    libraries = step(python, "-m", "penumbra", "doctor").split("LOADED FROM")[1]
    loaded = re.findall(r"/\S+", libraries)
    assert len(loaded) >= 5 and all(path.startswith(str(tmp_path)) for path in loaded), libraries
    assert int(step(python, "-c", CHECK, SHIPPED)) > 200_000
    told = step(python, "-m", "penumbra", "run", SHIPPED, "-o", tmp_path / "out")
    assert "12" in told and (tmp_path / "out" / "report.json").exists()
    step(python, "-m", "mypy", "--strict", "--no-incremental", ROOT / "examples" / "python" / "mask_depth.py")
