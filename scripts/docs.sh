#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a site of README.md and docs/, with the reference of Python and C++; a warning is an error.
#   scripts/docs.sh [OUT [BUILD]]
# OUT: build/docs/html. BUILD: a build folder whose Python module tells its reference; without it the
# module is built. The site needs no net, neither made nor read.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-build/docs/html}
build=${2:-build/docs/module}

if (($# < 2)); then
  scripts/packages.sh --install build python docs
  cmake --preset release -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=OFF -DPENUMBRA_WITH_PYTHON=ON \
    -DPENUMBRA_WITH_SIMULATION=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=24 -B "$build" >/dev/null
  cmake --build "$build" --target penumbra_python
fi

mkdir -p build/docs
rm -rf build/docs/doxygen
headers=$(PYTHONPATH=docs/site python3 -c "import reference
print(*(f'penumbra/{one}' for of in reference.HEADERS.values() for one in of))")
(cat docs/site/Doxyfile && echo "INPUT = $headers") | doxygen -
PYTHONPATH=$build/python "${PYTHON:-/usr/bin/python3}" -m sphinx -W --keep-going -E -a -q -b html \
  -c docs/site -d build/docs/doctrees . "$out"
if grep -rnE '(src=|<link[^>]*href=|url\()["'\'']?https?:' "$out" --include='*.html' --include='*.css'; then
  echo "docs.sh: what a page shows must be its own" >&2
  exit 1
fi
echo "site: $out/index.html"
