#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the renderer on this machine and writes it down.
#   scripts/bench.sh          bench/results/ but for the studies and Embree's views, then the tables
#                             of docs/performance.md, and its plots;
#                             some 15 minutes
#   scripts/bench.sh --gl     the OpenGL renderer alone, on this machine's device
#   scripts/bench.sh --quick  a few rounds only, to see that it runs; writes to build/bench/results
# Run it on a quiet machine. Packages: scripts/packages.sh --install build python bench
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=12 results=bench/results page=docs only_gl=false soak=(--soak)
case ${1:-} in
  "") ;;
  --gl) only_gl=true ;;
  --quick) rounds=1 results=build/bench/results page=build/bench/results soak=() ;;
  *)
    sed -n '3,8s/^# //p' "$0" >&2
    exit 2
    ;;
esac

cmake -S . -B build/bench -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENUMBRA_BUILD_BENCHMARKS=ON \
  -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=OFF >/dev/null
targets=(gl_benchmark)
$only_gl || targets+=(compare_renderers scaling target_benchmark pipeline_benchmark fringe_benchmark cpp_alone penumbra_app)
cmake --build build/bench --target "${targets[@]}"
mkdir -p "$results"
if ! $only_gl; then
  build/bench/bench/compare_renderers --rounds "$rounds" --json "$results/renderers.json" |
    tee "$results/renderers.txt"
  build/bench/bench/scaling --rounds "$rounds" --json "$results/scaling.json" |
    tee "$results/scaling.txt"
  build/bench/bench/target_benchmark --benchmark_min_time=0.05 \
    --benchmark_repetitions="$rounds" --benchmark_report_aggregates_only=true |
    tee "$results/targets.txt"
  build/bench/bench/pipeline_benchmark --benchmark_repetitions="$rounds" \
    --benchmark_report_aggregates_only=true | tee "$results/frames.txt"
  build/bench/bench/fringe_benchmark --benchmark_repetitions="$rounds" \
    --benchmark_report_aggregates_only=true | tee "$results/fringe.txt"
  bench/run_benchmark.sh build/bench/apps/penumbra/penumbra "$rounds" | tee "$results/run.txt"
  PYTHONPATH=build/bench/python:build/bench/bench "${PYTHON:-/usr/bin/python3}" bench/python_overhead.py \
    --rounds "$rounds" "${PENUMBRA_DATA:-../shared/data}/xarm7_realsense" | tee "$results/python.txt"
fi
device=$(build/bench/bench/gl_benchmark --name)
build/bench/bench/gl_benchmark --rounds "$rounds" "${soak[@]}" --json "$results/gl-$device.json" |
  tee "$results/gl-$device.txt"
[[ $page == docs ]] || cp docs/performance.md "$page/"
scripts/performance_page.py "$results" "$page"
