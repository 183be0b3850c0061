# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel: CMake makes the module and the command line that is shipped beside it.

The version is CMake's; CMake options go into the environment variable CMAKE_ARGS. The libraries that
a Linux machine may lack are in the wheel.
"""

import os
import pathlib
import platform
import re
import shlex
import shutil
import subprocess
import sys

import pybind11
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.absolute()
PARTS = ["-DPENUMBRA_BUILD_TESTS=OFF", "-DPENUMBRA_BUILD_BENCHMARKS=OFF", "-DPENUMBRA_BUILD_EXAMPLES=OFF",
         "-DPENUMBRA_WITH_SIMULATION=OFF", "-DPENUMBRA_WITH_PYTHON=ON", "-DPENUMBRA_WITH_TIFF=OFF",
         "-DPENUMBRA_WITH_EXR=OFF"]
# What older pybind11, such as Debian 12's, makes works with NumPy 1 only.
NUMPY = "numpy>=1.24,<3" if pybind11.version_info >= (2, 12) else "numpy>=1.24,<2"
# Every machine has these: the policy of manylinux (PEP 600).
SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\+\+|z))\.so\b.*")


def version() -> str:
    found = re.search(r"project\(Penumbra VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found, "CMakeLists.txt tells no version"
    return found[1]


def bundle(*programs: pathlib.Path) -> None:
    """Copies the shared libraries of programs next to them, where the programs look for them."""
    folder = programs[0].parent / "lib"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for program in programs:
        needed = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
        for name, path in re.findall(r"(\S+) => (/\S+)", needed):
            if not SYSTEM.fullmatch(name):
                shutil.copy(path, folder / name)
    for file in [*programs, *folder.iterdir()]:
        found_in = "$ORIGIN/" + os.path.relpath(folder, file.parent)
        subprocess.run(["patchelf", "--set-rpath", found_in, file], check=True)


class CMakeBuild(build_ext):
    """Installs CMake's component `python` where setuptools collects the wheel."""

    def build_extension(self, ext: Extension) -> None:
        module = pathlib.Path(self.get_ext_fullpath(ext.name)).absolute()
        build = pathlib.Path(self.build_temp).absolute()
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys.executable}", *PARTS,
                        f"-Dpybind11_DIR={pybind11.get_cmake_dir()}",
                        *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "penumbra_python", "penumbra_app"],
                       check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--strip", "--prefix",
                        module.parent.parent], check=True)
        bundle(module, module.parent / "bin" / "penumbra")


setup(version=version(), install_requires=[NUMPY],
      ext_modules=[Extension("penumbra._core", sources=[])],
      cmdclass={"build_ext": CMakeBuild},
      options={"bdist_wheel": {"plat_name": "manylinux_{}_{}".format(
          platform.libc_ver()[1].replace(".", "_"), platform.machine())}})
