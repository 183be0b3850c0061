# SPDX-License-Identifier: Apache-2.0
"""What the Python tests share: recordings, and the command line beside the module."""

import os
import pathlib
import subprocess
import sys

import numpy as np
from PIL import Image
import pytest

import penumbra

ROOT = pathlib.Path(__file__).parents[2]
SHIPPED = ROOT / "examples" / "arm_over_table"
DATA = pathlib.Path(os.environ.get("PENUMBRA_DATA") or
                    os.environ.get("PENUMBRA_DATA_DEFAULT", ROOT.parent / "shared" / "data"))
PROGRAM = pathlib.Path(penumbra.__file__).parent / "bin" / "penumbra"


# What takes long, or says little beside other tests.
only_in_full = pytest.mark.skipif(not os.environ.get("PENUMBRA_FULL"), reason="set PENUMBRA_FULL")


def skip_without_data():
    if not DATA.is_dir():
        assert "data" not in os.environ.get("PENUMBRA_REQUIRE", ""), f"{DATA} is not there"
        pytest.skip("no data")


class Opened:
    """A recording with all that judges its frames."""

    def __init__(self, folder, color=False, **config):
        self.frames = penumbra.open(folder, color=color)
        self.robot, self.camera = self.frames.robot, self.frames.camera
        self.config = self.frames.config.replace(**config)
        self.session = penumbra.Session(self.robot, self.camera, self.config)

    def targets(self):
        return self.frames.open_targets(image=self.config.image)


@pytest.fixture
def opened():
    return Opened(SHIPPED)


@pytest.fixture(scope="session")
def shipped():
    """One that is not changed by its tests."""
    return Opened(SHIPPED)


def execute(*words, status=0, **options):
    """A program, which must end with this status. Returns what it printed."""
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)
    assert done.returncode == status, done.stdout + done.stderr
    return done


def run(*words, **options):
    """The command line."""
    return execute(PROGRAM, *words, **options)


def run_python(*words, **options):
    return execute(sys.executable, *words, **options)


def refuses(says, call, error=penumbra.InputError):
    with pytest.raises(error, match=says):
        call()


def address(array):
    return array.__array_interface__["data"][0]


def read_png(file):
    """Pixel values of a grey or palette PNG, by an independent reader."""
    return np.array(Image.open(file)).astype(np.uint16)
