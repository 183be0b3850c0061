#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Formats the C++ sources; with --check only says which are not formatted. Run it before a commit.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") how=(-i) ;;
  --check) how=(--dry-run -Werror) ;;
  *)
    sed -n '3s/^# //p' "$0" >&2
    exit 2
    ;;
esac
git ls-files -z '*.cpp' '*.hpp' | xargs -0 -n 100 -P "$(nproc)" clang-format "${how[@]}"
