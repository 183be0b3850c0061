#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes Python wheels in build/wheel, and a list of what each consists of (.spdx.json).
#   scripts/wheel.sh [PYTHON...]   e.g. python3.10 python3.12; without one: the system's python3
# A Python that lacks NumPy, pybind11 or setuptools gets them from PyPI for the time of the build.
set -euo pipefail
cd "$(dirname "$0")/.."

for python in "$@"; do
  command -v "$python" >/dev/null || { echo "wheel.sh: no Python '$python' here" >&2; exit 2; }
done
scripts/packages.sh --install build ros python
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
for python in "${@:-/usr/bin/python3}"; do
  how=()
  if "$python" -c 'import numpy, pybind11, setuptools, wheel' 2>/dev/null; then how=(--no-build-isolation); fi
  "$python" -m pip wheel "${how[@]}" --no-deps -w build/wheel .
  made=$("$python" -c 'import sys, sysconfig; print(f"build/temp.{sysconfig.get_platform()}-{sys.implementation.cache_tag}")')
  python3 scripts/sbom.py "$made" "$(ls -t build/wheel/*.whl | head -n 1)"
done
echo "wheels: $(echo build/wheel/*.whl)"
