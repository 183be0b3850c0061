# SPDX-License-Identifier: Apache-2.0
"""A wheel, made and installed in a virtual environment without the net, brings its libraries along."""

import os
import re
import sys

from conftest import execute, only_in_full, ROOT, SHIPPED

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
