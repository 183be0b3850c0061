// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of the trackers: an estimate in order, one that is late by some others, and the
// question where the target is.
#include <benchmark/benchmark.h>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::bench {
namespace {

constexpr std::int64_t frame = 33'333'333;  // nanoseconds

PoseEstimate pose_at(std::int64_t stamp) {
  const double seconds = static_cast<double>(stamp) / 1e9;
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.pose.translation().x() = 0.2 * seconds;
  estimate.pose.linear() =
      Eigen::AngleAxisd(0.3 * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return estimate;
}

/// Estimates that come `late` frames after their successors: every other one of a stream.
void pose_update(benchmark::State& state) {
  PoseTracker tracker;
  const std::int64_t late = state.range(0);
  std::int64_t i = 0;
  for (auto _ : state) {
    tracker.update(pose_at(2 * i * frame), Verdict::visible);
    if (late > 0) tracker.update(pose_at((2 * (i - late) + 1) * frame), Verdict::visible);
    ++i;
  }
  state.SetItemsProcessed(state.iterations() * (late > 0 ? 2 : 1));
}

void pose_at_stamp(benchmark::State& state) {
  PoseTracker tracker;
  for (std::int64_t i = 0; i < 60; ++i) tracker.update(pose_at(i * frame), Verdict::visible);
  std::int64_t ahead = 0;
  for (auto _ : state) {
    ahead = (ahead + 1) % frame;
    benchmark::DoNotOptimize(tracker.at(60 * frame + ahead));
  }
}

void point_update(benchmark::State& state) {
  PointTracker tracker({.motion = PointMotion(state.range(0))});
  std::int64_t i = 0;
  for (auto _ : state) {
    tracker.update({i * frame, {1, 2, 3}}, Verdict::visible);
    ++i;
  }
}

void point_at_stamp(benchmark::State& state) {
  PointTracker tracker({.motion = PointMotion(state.range(0))});
  for (std::int64_t i = 0; i < 60; ++i) tracker.update({i * frame, {1, 2, 3}}, Verdict::visible);
  std::int64_t ahead = 0;
  for (auto _ : state) {
    ahead = (ahead + 1) % frame;
    benchmark::DoNotOptimize(tracker.at(60 * frame + ahead));
  }
}

BENCHMARK(pose_update)->Name("pose update, late by others")->Arg(0)->Arg(1)->Arg(4)->Arg(14);
BENCHMARK(pose_at_stamp)->Name("pose at a stamp");
BENCHMARK(point_update)->Name("point update, held/moving")->Arg(0)->Arg(1);
BENCHMARK(point_at_stamp)->Name("point at a stamp, held/moving")->Arg(0)->Arg(1);

}  // namespace
}  // namespace penumbra::bench

BENCHMARK_MAIN();
