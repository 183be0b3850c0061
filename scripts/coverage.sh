#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Line coverage of the C++ code: prints a table by folder and writes build/coverage/html/index.html.
#   scripts/coverage.sh                     by all tests, which takes long
#   scripts/coverage.sh CTEST OPTIONS...    by some tests, as -L plain or -R '^Classifier'
# Configure before, to build less:
#   cmake --preset coverage -DPENUMBRA_BUILD_APPS=OFF
# A line is covered if it ran in any process and for any SIMD target. GCC's -O1 merges some lines,
# which then count as one.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/packages.sh --install build ros python sim test coverage

build=build/coverage
cmake --preset coverage >/dev/null
nice -n 10 cmake --build --preset coverage -j "$(nproc)"
find "$build" -name '*.gcda' -delete  # counts of an earlier run
nice -n 10 ctest --preset coverage -j "$(nproc)" "$@" || echo "tests failed: what they ran is counted, too" >&2

# Of the product's objects, not of those of its tests.
objects=()
for folder in penumbra io sim apps python; do
  [[ ! -d $build/$folder ]] || objects+=("$build/$folder")
done
mkdir -p "$build/html"
nice -n 10 gcovr --root . --filter '(penumbra|io|sim|apps|python)/' -j "$(nproc)" \
  --csv "$build/lines.csv" --html-details "$build/html/index.html" "${objects[@]}"

echo "$(g++ --version | sed 1q), -O1; ctest ${*:-of all tests}"
awk -F, '
  NR == 1 { next }
  {
    depth = split($1, part, "/")
    folder = depth > 2 ? part[1] "/" part[2] : part[1]
    lines[folder] += $2; covered[folder] += $3
    lines["~all"] += $2; covered["~all"] += $3
  }
  END {
    for (folder in lines) if (lines[folder])
      printf "%-22s %6d lines %5.1f %%\n", folder, lines[folder], 100 * covered[folder] / lines[folder]
  }' "$build/lines.csv" | LC_ALL=C sort | tr -d '~'
