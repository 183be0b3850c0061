#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# scripts/cross.sh [CTEST OPTION...]: builds for 64-bit ARM and runs the tests under qemu. Without
# OpenGL, the simulation and Python. Debian 12; root only if packages are missing or the kernel does
# not know qemu.
set -euo pipefail
cd "$(dirname "$0")/.."
sysroot=build/arm64-sysroot

scripts/packages.sh --install build cross

# The libraries for arm64, without a change to this machine's packages.
if [[ ! -e $sysroot/complete ]]; then
  rm -rf "$sysroot"
  mkdir -p "$sysroot"/usr/{lib,bin,sbin} "$sysroot"/apt/{state/lists/partial,cache/archives/partial}
  for folder in lib bin sbin; do ln -s "usr/$folder" "$sysroot/$folder"; done
  apt=$PWD/$sysroot/apt
  : > "$apt/status"
  options=(-qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$apt/state"
           -o Dir::State::status="$apt/status" -o Dir::Cache="$apt/cache"
           -o APT::Sandbox::User="$(id -un)" -o Debug::NoLocking=1)
  apt-get "${options[@]}" update
  mapfile -t packages < <(scripts/packages.sh build ros test | grep -- '-dev$' | grep -v clang)
  apt-get "${options[@]}" install --download-only --no-install-recommends -y libc6-dev \
    "${packages[@]}"
  for package in "$apt"/cache/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$sysroot" --keep-directory-symlink
  done
  # As Debian's alternatives do.
  for library in blas lapack; do
    ln -s "$library/lib$library.so.3" "$sysroot/usr/lib/aarch64-linux-gnu/lib$library.so.3"
  done
  # Absolute paths would lead out of it.
  find "$sysroot/usr" -name '*.cmake' -exec sed -i -E "s#(^|[^[:alnum:]_.}/-])/usr/(lib|include)#\1$PWD/$sysroot/usr/\2#g" {} +
  find "$sysroot" -type l -lname '/*' | while read -r link; do
    ln -snf "$(realpath -m --relative-to="$(dirname "$link")" "$sysroot$(readlink "$link")")" "$link"
  done
  rm -rf "$apt"
  touch "$sysroot/complete"
fi

cmake --preset arm64
cmake --build --preset arm64

# Tests start programs for arm64. systemd lets the kernel run these with qemu; a container may lack it.
export QEMU_LD_PREFIX=$PWD/$sysroot
kernel=/proc/sys/fs/binfmt_misc
if [[ ! -e $kernel/qemu-aarch64 ]]; then
  [[ -e $kernel/register ]] || mount -t binfmt_misc none $kernel
  cat /usr/lib/binfmt.d/qemu-aarch64.conf >$kernel/register
fi
ctest --preset arm64 "$@"
