#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks types, format and unit tests, builds the page with the pinned tools, and compares it with
# web/dist.
set -euo pipefail
cd "$(dirname "$0")"

built=$(mktemp -d)
trap 'rm -rf "$built"' EXIT

npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2
npm run --silent check
npm test --silent
node build.mjs "$built"
if ! diff -r "$built" dist; then
  echo "web/dist differs from its sources: run npm run build in web/ and commit web/dist" >&2
  exit 1
fi
