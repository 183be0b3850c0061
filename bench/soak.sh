#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the latency and the memory of `penumbra live` over DDS (docs/latency.md):
#   bench/soak.sh [SECONDS]   default 7200
# `penumbra play` repeats a simulated recording of 640x480 at 30 Hz, and live_latency subscribes to
# the results. All three have real-time priority where that is permitted, and a network of their own.
# build/soak/results has the latency of each frame, the memory of each minute, and the programs' logs.
# Packages: scripts/packages.sh --install build bench ros
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/soak results=build/soak/results

if [[ ${1:-} != --alone ]]; then
  if (($# > 1)) || [[ ! ${1:-7200} =~ ^[0-9]+$ ]]; then
    sed -n '3,8s/^# \{0,1\}//p' "$0" >&2
    exit 2
  fi
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_WITH_DDS=ON \
    -DPENUMBRA_WITH_SIMULATION=ON -DPENUMBRA_BUILD_BENCHMARKS=ON -DPENUMBRA_BUILD_TESTS=OFF \
    -DPENUMBRA_BUILD_EXAMPLES=OFF >/dev/null
  cmake --build "$build" --target penumbra_app live_latency
  rm -rf "$results"
  mkdir "$results"
  "$build/apps/penumbra/penumbra" simulate conveyor -o "$results/belt.mcap"
  alone=() first=()
  for way in "unshare -n" "unshare -rn"; do
    read -ra alone <<<"$way"
    "${alone[@]}" ip link set lo up 2>/dev/null && break
    alone=()
  done
  chrt -r 10 true 2>/dev/null && first=(chrt -r 10)
  exec "${first[@]}" "${alone[@]}" bench/soak.sh --alone "${1:-7200}"
fi

ip link set lo up 2>/dev/null || true # it is up already in a shared network
export ROS_DOMAIN_ID=101 ROS_LOCALHOST_ONLY=1
unset CYCLONEDDS_URI
"$build/apps/penumbra/penumbra" play "$results/belt.mcap" --loop --restamp >"$results/play.log" 2>&1 &
play=$!
"$build/apps/penumbra/penumbra" live --reliable --publish labels,filtered_depth \
  --package arm_description="$results/arm_description" --summary "$results/live.json" \
  >"$results/live.log" 2>&1 &
live=$!
trap 'kill $play $live 2>/dev/null || true' EXIT
{
  awk -F': *' '/^model name/ { print $2; exit }' /proc/cpuinfo
  echo "$(nproc) cores, $(chrt -p $$ | head -n 1), load average $(cut -d' ' -f1-3 /proc/loadavg)"
  "$build/bench/live_latency" "$live" "$2" "$results/frames.csv"
  echo "load average $(cut -d' ' -f1-3 /proc/loadavg)"
} | tee "$results/minutes.log"
kill -INT $play
wait $play
kill -INT $live
wait $live
