#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The names of Debian's packages.
#   scripts/packages.sh GROUP...            prints the packages of the groups
#   scripts/packages.sh --install GROUP...  installs those that are not there yet, without questions
# Groups: build (library and command line), ros (its live topics of ROS 2), python (import penumbra;
# matplotlib for its examples), sim (simulation), research (the paper's experiments), test, web (the
# page's tests), docs (the site), bench, lint, coverage (scripts/coverage.sh), cross
# (scripts/cross.sh), deb (scripts/deb.sh; what the packages are built with is in debian/control).
# OpenGL is tested on Mesa's software driver; the driver of a GPU next to libegl1 and libopengl0
# also works.
set -euo pipefail

build=(g++ cmake ninja-build libeigen3-dev libhwy-dev libtinyxml2-dev libmeshoptimizer-dev
       libyaml-cpp-dev libpng-dev libcli11-dev nlohmann-json3-dev libepoxy-dev pkgconf
       libdeflate-dev libjpeg-dev libtiff-dev libopenexr-dev liblz4-dev libzstd-dev libsqlite3-dev libboost-dev zlib1g-dev)
ros=(cyclonedds-dev nettle-dev)
python=(pybind11-dev python3-pybind11 python3-dev python3-numpy python3-setuptools python3-wheel python3-venv python3-pip
        python3-matplotlib patchelf dpkg-dev)
sim=(libmujoco-dev libepoxy-dev libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri)
research=(libopencv-calib3d-dev libopencv-features2d-dev libopencv-imgproc-dev)
test=(libgtest-dev libassimp-dev libembree-dev liburdfdom-dev libopencv-calib3d-dev
      libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri libfastcdr-dev libfastrtps-dev nodejs npm
      ffmpeg clang libclang-rt-14-dev colcon python3-colcon-package-information python3-colcon-package-selection
      python3-colcon-ros
      python3-catkin-pkg python3-distributed python3-pytest python3-mypy python3-yaml python3-pil
      python3-h5py python3-av)
web=(chromium fonts-dejavu-core nodejs npm)
docs=(doxygen python3-breathe python3-sphinx python3-myst-parser furo)
bench=(libbenchmark-dev libembree-dev libegl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri)
lint=(clang-format clang-tidy)
coverage=(gcovr)
cross=(crossbuild-essential-arm64 qemu-user-static)
deb=(dpkg-dev lintian abigail-tools)

install=false
if [[ ${1:-} == --install ]]; then
  install=true
  shift
fi
if (($# == 0)); then
  sed -n '3,11s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi

groups=" build ros python sim research test web docs bench lint coverage cross deb "
packages=()
for group in "$@"; do
  if [[ $groups != *" $group "* ]]; then
    echo "packages.sh: unknown group '$group' (one of:${groups% })" >&2
    exit 2
  fi
  declare -n of_group=$group
  packages+=("${of_group[@]}")
done

if ! $install; then
  printf '%s\n' "${packages[@]}" | sort -u
  exit
fi

missing=()
for package in "${packages[@]}"; do
  # Node.js of other makers brings its npm along and refuses Debian's.
  [[ $package != npm ]] || ! command -v npm >/dev/null || continue
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $state == installed ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

echo "installing: ${missing[*]}" >&2
as_root=()
((EUID == 0)) || as_root=(sudo)
wait=(-o DPkg::Lock::Timeout=600)  # seconds, while another process installs
"${as_root[@]}" apt-get "${wait[@]}" update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get "${wait[@]}" install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
