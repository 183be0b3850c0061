#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds libFuzzer's programs, one for each reader, into $OUT (build/fuzz/out) with their seeds and
# dictionaries, as OSS-Fuzz wants them: with its $CXX, $CXXFLAGS and $LIB_FUZZING_ENGINE, where set.
#   scripts/fuzz.sh                      builds
#   scripts/fuzz.sh SECONDS [READER...]  also runs them so long; what they find is in build/fuzz/found
set -euo pipefail
cd "$(dirname "$0")/.."
if [[ ! ${1:-1} =~ ^[0-9]+$ ]]; then
  sed -n '3,6s/^# //p' "$0" >&2
  exit 2
fi
export OUT=${OUT:-$PWD/build/fuzz/out} FOUND=$PWD/build/fuzz/found SECONDS_EACH=${1:-0}
[[ ! -d /dev/shm ]] || export TMPDIR=/dev/shm  # bytes become files many times a second

of_engine=()
[[ -z ${LIB_FUZZING_ENGINE:-} ]] ||
  of_engine=(-DPENUMBRA_SANITIZE= "-DCMAKE_CXX_COMPILER=$CXX" "-DCMAKE_CXX_FLAGS=${CXXFLAGS:-}")
cmake --preset fuzz "${of_engine[@]}" >/dev/null
nice -n 19 cmake --build --preset fuzz --target fuzzer -j "$(nproc)"
mkdir -p "$OUT" "$FOUND"
mapfile -t readers < <(build/fuzz/tests/fuzz/fuzzer || true)
for reader in "${readers[@]}"; do
  ln -f build/fuzz/tests/fuzz/fuzzer "$OUT/$reader" 2>/dev/null || cp build/fuzz/tests/fuzz/fuzzer "$OUT/$reader"
  python3 -m zipfile -c "$OUT/${reader}_seed_corpus.zip" "tests/fuzz/seeds/$reader/"*
  [[ ! -e tests/fuzz/dictionaries/$reader.dict ]] || cp "tests/fuzz/dictionaries/$reader.dict" "$OUT"
done
((SECONDS_EACH > 0)) || exit 0

# run READER: prints its figures; fails for a crash, hang or great allocation.
run() {
  local log=$FOUND/$1.log dictionary=() most=512  # MB
  [[ $1 != exr ]] || most=2048  # file_readers.cpp says why
  [[ ! -e $OUT/$1.dict ]] || dictionary=("-dict=$OUT/$1.dict")
  mkdir -p "$FOUND/$1"
  "$OUT/$1" "-max_total_time=$SECONDS_EACH" -timeout=10 -rss_limit_mb=2048 "-malloc_limit_mb=$most" \
    -print_final_stats=1 "-artifact_prefix=$FOUND/$1-" "${dictionary[@]}" "$FOUND/$1" \
    "tests/fuzz/seeds/$1" >"$log" 2>&1 || { tail -n 30 "$log"; echo "$1: FAILED"; return 1; }
  echo "$1: $(sed -n 's/^Done //p' "$log")"
}
export -f run
((${#@} < 2)) || readers=("${@:2}")
printf '%s\n' "${readers[@]}" | nice -n 10 xargs -P "$(nproc)" -I{} bash -c 'run {}'
