#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds Penumbra and runs it on the shipped recording: pictures and report in out/demo (or in $1).
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-out/demo}

scripts/packages.sh --install build
cmake --preset release -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=OFF \
  -DPENUMBRA_WARNINGS_AS_ERRORS=OFF -B build/demo >/dev/null
cmake --build build/demo --target penumbra_demo

build/demo/apps/penumbra/penumbra-demo run examples/arm_over_table -o "$out" \
  --save overlay,labels,links,vdi
echo "pictures: $out/overlay/*.png   labels: $out/labels/*.png   report: $out/report.json"
echo 'next: "cmake --build build/demo" builds the rest: bags, the browser, calibration and more;'
echo 'then: build/demo/apps/penumbra/penumbra view examples/arm_over_table'
