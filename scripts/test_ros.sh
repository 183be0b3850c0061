#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the packages with colcon in build/ros_ws and runs the node's tests, where a ROS 2 is sourced
# (Humble or later).
#   scripts/test_ros.sh [ARGUMENTS OF CMAKE...]
# The last line is "N passed, N failed[, N skipped]"; the exit status is 0 if none failed.
set -uo pipefail
cd "$(dirname "$0")/.." || exit
if [[ -z ${AMENT_PREFIX_PATH:-} ]] || ! command -v colcon >/dev/null; then
  echo "0 passed, 0 failed, 1 skipped: no ROS 2 is sourced, or there is no colcon"
  exit 0
fi

root=$PWD
mkdir -p build/ros_ws && cd build/ros_ws || exit
export ROS_AUTOMATIC_DISCOVERY_RANGE=${ROS_AUTOMATIC_DISCOVERY_RANGE-LOCALHOST}
export ROS_DOMAIN_ID=${ROS_DOMAIN_ID-$((RANDOM % 9 + 1))}  # the other tests use 10 to 99
places=(--base-paths "$root" "$root/ros")
nice -n 19 colcon build "${places[@]}" --merge-install --executor sequential \
  --cmake-args -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_ONLY_NODE=ON "$@" || { echo "0 passed, 1 failed"; exit 1; }
set +u
# shellcheck disable=SC1091
. install/setup.bash
set -u
colcon test "${places[@]}" --merge-install --packages-select penumbra_ros
summary=$(colcon test-result --test-result-base build/penumbra_ros --all | tail -n 1)
echo "$summary"
count() { sed -nE "s/.* ([0-9]+) $1.*/\1/p" <<<" $summary"; }
all=$(count tests) failed=$(($(count errors) + $(count failures))) skipped=$(count skipped)
echo "$((all - failed - skipped)) passed, $failed failed, $skipped skipped"
((failed == 0 && all > 0))
