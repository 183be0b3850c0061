#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the renderers on this machine and writes it down.
#   scripts/bench.sh          bench/results/ without the studies and Embree's views, then the tables
#                             of docs/performance.md, and its plots; some 15 minutes
#   scripts/bench.sh --quick  a few rounds only, to see that it runs; writes to build/bench/results
# Run it on a quiet machine. Packages: scripts/packages.sh --install build bench
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=12 results=bench/results page=docs
case ${1:-} in
  "") ;;
  --quick) rounds=1 results=build/bench/results page=build/bench/results ;;
  *)
    sed -n '3,7s/^# //p' "$0" >&2
    exit 2
    ;;
esac

cmake -S . -B build/bench -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_BUILD_BENCHMARKS=ON \
  -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=OFF >/dev/null
cmake --build build/bench --target compare_renderers scaling pipeline_benchmark fringe_benchmark look_ahead_benchmark cloud_benchmark camera_load penumbra_app
mkdir -p "$results"
build/bench/bench/compare_renderers --rounds "$rounds" --json "$results/renderers.json" |
  tee "$results/renderers.txt"
build/bench/bench/scaling --rounds "$rounds" --json "$results/scaling.json" |
  tee "$results/scaling.txt"
build/bench/bench/pipeline_benchmark --benchmark_repetitions="$rounds" \
  --benchmark_report_aggregates_only=true | tee "$results/frames.txt"
build/bench/bench/fringe_benchmark --benchmark_repetitions="$rounds" \
  --benchmark_report_aggregates_only=true | tee "$results/fringe.txt"
for load in "40 --threads 1" "60 --threads 1" "100 --threads 1" "100 --threads 2"; do
  # shellcheck disable=SC2086  # several arguments
  build/bench/bench/camera_load --seconds 60 --cameras $load
done | tee "$results/cameras.txt"
build/bench/bench/look_ahead_benchmark | tee "$results/look_ahead.txt"
build/bench/bench/cloud_benchmark | tee "$results/cloud.txt"
[[ ! -x build/bench/bench/lidar_study ]] ||  # needs MuJoCo
  build/bench/bench/lidar_study | tee "$results/lidar.txt"
bench/run_benchmark.sh build/bench/apps/penumbra/penumbra "$rounds" | tee "$results/run.txt"
[[ $page == docs ]] || cp docs/performance.md "$page/"
scripts/performance_page.py "$results" "$page"
