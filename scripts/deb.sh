#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# scripts/deb.sh [OPTION OF dpkg-buildpackage...]: Debian packages of the last commit in build/deb,
# checked by lintian. docs/install.md tells how to cross-build them for arm64.
set -euo pipefail
cd "$(dirname "$0")/.."

# To cross-build, apt-get build-dep gets the libraries.
(($#)) || scripts/packages.sh --install build ros sim python deb
rm -rf build/deb
git clone -q . build/deb/penumbra
cd build/deb/penumbra
dpkg-buildpackage -us -uc -b "$@"
lintian --fail-on error ../penumbra_*.changes
ls -l ../*.deb
