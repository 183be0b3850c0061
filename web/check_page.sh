#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the page of a program in Debian's Chromium: web/check_page.sh PROGRAM.
# PENUMBRA_BASELINES=write replaces the baseline screenshots; review them before you commit.
set -euo pipefail
PENUMBRA=$(realpath "${1:?which program? build/release/apps/penumbra/penumbra}")
export PENUMBRA
cd "$(dirname "$0")"
[[ -d node_modules/playwright-core ]] || npm ci --ignore-scripts --loglevel=error >&2
node --test tests/page/all.mjs
