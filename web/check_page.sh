#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Drives the page in Debian's Chromium, as it is built into a program: web/check_page.sh PROGRAM.
# PENUMBRA_BASELINES=write keeps the pictures anew; look at them before they are committed.
set -euo pipefail
PENUMBRA=$(realpath "${1:?which program? build/release/apps/penumbra/penumbra}")
export PENUMBRA
cd "$(dirname "$0")"
[[ -d node_modules/playwright-core ]] || npm ci --ignore-scripts --loglevel=error >&2
# One file after the other: each drives a browser that draws with the CPU.
node --test --test-concurrency=1 tests/page/*_test.mjs
