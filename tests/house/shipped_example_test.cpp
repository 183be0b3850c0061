// SPDX-License-Identifier: Apache-2.0
// The whole method on the shipped recording, against its truth: an independent ray caster's.
#include "../support/pixels.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/png.hpp>
#include <io/files/recording.hpp>

namespace penumbra::test {
namespace {

enum Truth : std::uint8_t { no_robot = 0, robot_seen = 1, before_robot = 2, hidden = 3 };

// Pixels at a border that depth noise may blur: the recording's borders wander by about one pixel,
// and a measurement mixes a neighbourhood of one more.
constexpr int edge_band = 2;

// Of the robot's pixels: tessellated cylinders and float meshes against exact ones, at silhouettes.
constexpr double most_covered_differently = 0.002;

constexpr double most_false_front = 0.005;  // of the pixels where the robot is seen
constexpr double least_found_front = 0.99;  // of the measured pixels of things before the robot

/// Whether `rule` holds for every truth within `reach` of (u, v).
template <typename Rule>
bool all_near(const Image<std::uint8_t>& truth, int u, int v, int reach, Rule&& rule) {
  for (const auto [x, y] :
       each_pixel(std::max(0, u - reach), std::max(0, v - reach),
                  std::min(truth.width(), u + reach + 1), std::min(truth.height(), v + reach + 1)))
    if (!rule(truth(x, y))) return false;
  return true;
}

struct Counts {
  std::size_t robot = 0, covered_differently = 0, inner_covered_differently = 0;
  std::size_t seen = 0, false_front = 0, before = 0, found = 0;
};

void count(const FrameReport& report, const Image<std::uint8_t>& truth,
           ImageView<const std::uint16_t> depth, Counts& counts) {
  for (const auto [u, v] : each_pixel(truth)) {
    const std::uint8_t value = truth(u, v);
    const auto same = [value](std::uint8_t other) { return other == value; };
    const bool front = report.labels(u, v) == static_cast<std::uint8_t>(Label::front);
    if (value != no_robot) ++counts.robot;
    if ((value != no_robot) != (report.virtual_depth.depth(u, v) > 0.0F)) {
      ++counts.covered_differently;
      if (all_near(truth, u, v, 1, same)) ++counts.inner_covered_differently;
    }
    if (value == robot_seen || value == hidden) {
      ++counts.seen;
      // The border of what stands before the robot may be measured outside of it.
      const auto free = [](std::uint8_t other) { return other != before_robot; };
      if (front && all_near(truth, u, v, edge_band, free)) ++counts.false_front;
    }
    if (value == before_robot && depth(u, v) != 0 && all_near(truth, u, v, edge_band, same)) {
      ++counts.before;
      if (front) ++counts.found;
    }
  }
}

Counts judge_recording() {
  const std::filesystem::path folder = PENUMBRA_SOURCE_DIR "/examples/arm_over_table";
  const auto recording = io::Recording::open(folder);
  Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Pipeline pipeline(std::move(robot), recording.camera.camera, recording.pipeline_config());

  Counts counts;
  Image<std::uint8_t> truth;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame frame = frames.read(i, false);
    const auto& report = pipeline.process(frame);
    EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
    io::read_png(folder / "truth" / (std::to_string(i) + ".png"), truth).require();
    count(report, truth, std::get<ImageView<const std::uint16_t>>(frame.depth.view), counts);
  }
  return counts;
}

double part(std::size_t some, std::size_t all) {
  return static_cast<double>(some) / static_cast<double>(all);
}

TEST(ShippedExample, LabelsAgreeWithTheTruth) {
  const Counts counts = judge_recording();
  EXPECT_GT(counts.robot, 100'000U);
  EXPECT_EQ(counts.inner_covered_differently, 0U);
  EXPECT_LE(part(counts.covered_differently, counts.robot), most_covered_differently);
  EXPECT_LE(part(counts.false_front, counts.seen), most_false_front);
  EXPECT_GT(counts.before, 5'000U);
  EXPECT_GE(part(counts.found, counts.before), least_found_front);
}

}  // namespace
}  // namespace penumbra::test
