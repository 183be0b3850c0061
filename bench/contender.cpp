// SPDX-License-Identifier: Apache-2.0
#include "contender.hpp"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

void draw_one_by_one(const Contender& contender, FrameTimes& times, std::size_t frames) {
  for (std::size_t frame = 0; frame < frames; ++frame) {
    times.add(frame, time_ms([&] {
                contender.submit(frame);
                contender.collect();
              }));
  }
}

void draw_ahead(const Contender& contender, std::size_t frames) {
  int pending = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (pending == contender.max_pending) {
      contender.collect();
      --pending;
    }
    contender.submit(frame);
    ++pending;
  }
  for (; pending > 0; --pending) contender.collect();
}

}  // namespace

std::vector<FrameCosts> measure(const std::vector<Contender>& contenders, std::size_t frames,
                                int rounds) {
  std::vector<FrameCosts> all(contenders.size(), FrameCosts(frames));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const Contender& contender = contenders[i];
      FrameCosts& costs = all[i];
      draw_ahead(contender, static_cast<std::size_t>(contender.max_pending));  // warms up
      costs.waiting.add(
          cost_of_pass(frames, [&] { draw_one_by_one(contender, costs.blocking, frames); }));
      costs.with_frames_ahead.add(cost_of_pass(frames, [&] { draw_ahead(contender, frames); }));
    }
  }
  return all;
}

void print_costs_head(const std::string& title) {
  std::printf("\n%-34s %9s %9s %9s %9s | %10s %9s %9s\n", title.c_str(), "typical", "median", "CPU",
              "thread", "frames/s", "CPU", "thread");
}

nlohmann::json print_costs(const Contender& contender, const FrameCosts& costs) {
  const PassCost waiting = costs.waiting.least();
  const PassCost ahead = costs.with_frames_ahead.least();
  std::printf("%-34s %9.3f %9.3f %9.3f %9.3f | %10.0f %9.3f %9.3f\n", contender.name.c_str(),
              costs.blocking.typical(), costs.blocking.median(), waiting.process_ms,
              waiting.thread_ms, 1e3 / ahead.wall_ms, ahead.process_ms, ahead.thread_ms);
  std::fflush(stdout);
  const PassCost median_ahead = costs.with_frames_ahead.median();
  return {{"name", contender.name},
          {"typical_ms", costs.blocking.typical()},
          {"median_ms", costs.blocking.median()},
          {"min_ms", costs.blocking.min()},
          {"cpu_ms", waiting.process_ms},
          {"cpu_median_ms", costs.waiting.median().process_ms},
          {"thread_ms", waiting.thread_ms},
          {"frames_ahead", contender.max_pending},
          {"ahead_frames_per_s", 1e3 / ahead.wall_ms},
          {"ahead_median_frames_per_s", 1e3 / median_ahead.wall_ms},
          {"ahead_cpu_ms", ahead.process_ms},
          {"ahead_thread_ms", ahead.thread_ms}};
}

}  // namespace penumbra::bench
