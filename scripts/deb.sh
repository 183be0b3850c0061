#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# scripts/deb.sh [OPTION OF dpkg-buildpackage...]: Debian packages of the last commit in build/deb,
# checked by lintian, and what they consist of (.spdx.json). To cross-build: scripts/deb.sh -aarm64 -Pcross
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/packages.sh --install deb
rm -rf build/deb/penumbra
git clone -q . build/deb/penumbra
cd build/deb/penumbra
if ! dpkg-checkbuilddeps "$@" 2>/dev/null; then
  as_root=()
  ((EUID == 0)) || as_root=(sudo)
  "${as_root[@]}" apt-get build-dep -qq -y --no-install-recommends "$@" ./ >/dev/null
fi
rm -f ../penumbra_*.changes
SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -S Timestamp)
export SOURCE_DATE_EPOCH
DEB_BUILD_OPTIONS=noautodbgsym dpkg-buildpackage -us -uc -b "$@"
lintian --fail-on error,warning ../penumbra_*.changes
python3 scripts/sbom.py build/deb-* ../penumbra_*.changes
ls -l ../*.deb
