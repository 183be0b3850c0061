#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the shipped recording again, with the same bytes.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/packages.sh --install build
cmake --preset release -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=ON -B build/demo >/dev/null
cmake --build build/demo --target make_arm_over_table
build/demo/examples/make_arm_over_table/make_arm_over_table examples/arm_over_table
git status --short examples/arm_over_table
