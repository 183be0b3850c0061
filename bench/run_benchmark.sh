#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Times `penumbra run` with nothing saved but the report, start-up and PNG decoding included:
#   bench/run_benchmark.sh PENUMBRA [ROUNDS]
# PENUMBRA is the program. The recording is the ten frames of xarm7_realsense (PENUMBRA_DATA, else
# ../shared/data) thirty times over, 1280x720, in a temporary folder. Wall time is worth
# something on a quiet machine alone, CPU time on a busy one too.
set -euo pipefail
cd "$(dirname "$0")/.."
if (($# < 1 || $# > 2)); then
  sed -n '3,7s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
program=$1 rounds=${2:-7} repeats=30
data=$(realpath "${PENUMBRA_DATA:-../shared/data}/xarm7_realsense")

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
recording=$folder/recording
mkdir "$recording"
cp "$data"/camera_{info.yaml,pose.csv} "$recording"
sed -e "s|: \.\./robots|: $data/../robots|" -e '/color:/d' "$data/recording.yaml" >"$recording/recording.yaml"
head -1 "$data/joint_states.csv" >"$recording/joint_states.csv"
for ((frame = 0; frame < 10 * repeats; ++frame)); do
  cp "$data/depth_$((frame % 10)).png" "$recording/depth_$frame.png"
  awk -F, -v OFS=, -v from=$((frame % 10)) -v to=$frame \
    '$1 == from { $1 = to; print }' "$data/joint_states.csv" >>"$recording/joint_states.csv"
done

TIMEFORMAT='%R %U %S'
for ((round = 0; round < rounds; ++round)); do
  { time "$program" run "$recording" -o "$folder/out" >"$folder/said" 2>"$folder/notes"; } 2>>"$folder/times"
done
model=$(awk -F': *' '/^model name/ { print $2; exit }' /proc/cpuinfo)
echo "$model, load average $(cut -d' ' -f1 /proc/loadavg) at the end"
sort -n "$folder/times" | awk -v frames=$((10 * repeats)) '
  NR == 1 { wall = $1 }
  NR == 1 || $2 + $3 < cpu { cpu = $2 + $3 }
  END { printf "%d frames of 1280x720, fastest of %d rounds: %.2f s, %.1f frames/s; CPU time %.2f s, %.1f frames/s of one core\n",
               frames, NR, wall, frames / wall, cpu, frames / cpu }'
grep -v "^report:" "$folder/said"
