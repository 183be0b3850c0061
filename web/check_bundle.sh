#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the page from its sources, with the pinned tools, and says whether web/dist is what comes
# out. Types, format and unit tests are looked at first.
set -euo pipefail
cd "$(dirname "$0")"

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2
npm run --silent check
npm test --silent
node build.mjs "$made"
if ! diff -r "$made" dist; then
  echo "web/dist is not what its sources give: npm run build in web/, and commit web/dist" >&2
  exit 1
fi
