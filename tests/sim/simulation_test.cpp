// SPDX-License-Identifier: Apache-2.0
// Scenes: the same seed gives the same bytes, and what makes no sense is refused.
#include "simulated.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>

namespace penumbra::test {
namespace {

using sim::SimFrame;
using sim::Simulation;
using sim::SimulationOptions;

template <typename T>
bool same(const Image<T>& a, const Image<T>& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::equal(a.data(), a.data() + a.size(), b.data());
}

bool same(const SimFrame& a, const SimFrame& b) {
  return a.stamp == b.stamp && same(a.color, b.color) && same(a.depth, b.depth) &&
         same(a.ids, b.ids) && same(a.second_depth, b.second_depth) && a.joints == b.joints &&
         a.true_joints == b.true_joints;
}

SimulationOptions noisy(const std::string& scene, std::uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  options.joint_sigma = 0.001;
  options.second_camera = true;
  if (scene != "random") options.joint_latency = 0.01;
  return options;
}

class Scenes : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_SIMULATION(); }
};

TEST_P(Scenes, SameSeedGivesTheSameBytes) {
  Simulation one(GetParam(), noisy(GetParam(), 7)), two(GetParam(), noisy(GetParam(), 7)),
      other(GetParam(), noisy(GetParam(), 8));
  two.skip(2);
  SimFrame a, b, c;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(one.next(a));
    ASSERT_TRUE(other.next(c));
    EXPECT_FALSE(same(a, c)) << "another seed, frame " << i;
  }
  ASSERT_TRUE(two.next(b));
  EXPECT_TRUE(same(a, b)) << "a frame does not depend on those before";
}

TEST_P(Scenes, SeveralAtOnceGiveTheSameBytes) {
  constexpr int count = 3;
  const auto third_frame = [&](int i, SimFrame& frame) {
    Simulation simulation(GetParam(), noisy(GetParam(), static_cast<std::uint64_t>(i)));
    for (int k = 0; k < 3; ++k) simulation.next(frame);
  };
  std::array<SimFrame, count> alone, together;
  for (int i = 0; i < count; ++i) third_frame(i, alone[static_cast<std::size_t>(i)]);
  {
    std::vector<std::jthread> threads;
    threads.reserve(count);
    for (int i = 0; i < count; ++i)
      threads.emplace_back([&, i] { third_frame(i, together[static_cast<std::size_t>(i)]); });
  }
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_FALSE(alone[i].depth.empty());
    EXPECT_TRUE(same(alone[i], together[i])) << i;
  }
}

TEST_P(Scenes, LastAsLongAsTheySay) {
  SimulationOptions options = without_noise(1);
  options.duration = 0.2;
  options.frame_rate = 20.0;
  Simulation simulation(GetParam(), options);
  SimFrame frame;
  std::size_t count = 0;
  std::int64_t last = 0;
  while (simulation.next(frame)) {
    if (count++ > 0) {
      EXPECT_EQ(frame.stamp - last, 50'000'000);
    }
    last = frame.stamp;
  }
  EXPECT_EQ(count, 4U);
  EXPECT_EQ(simulation.frames(), 4U);
}

TEST_P(Scenes, CountsAgreeWithTheImages) {
  Simulation simulation(GetParam(), without_noise(3));
  simulation.skip(simulation.frames() / 2);
  SimFrame frame;
  ASSERT_TRUE(simulation.next(frame));
  ASSERT_FALSE(frame.objects.empty());
  for (const auto& object : frame.objects) {
    const auto seen = static_cast<std::size_t>(
        std::count(frame.ids.data(), frame.ids.data() + frame.ids.size(), object.id));
    const auto alone = static_cast<std::size_t>(
        std::count(object.alone.data(), object.alone.data() + object.alone.size(), 1));
    EXPECT_EQ(object.pixels_seen, seen) << object.name;
    EXPECT_EQ(object.pixels_alone, alone) << object.name;
    EXPECT_GE(object.pixels_alone, object.pixels_seen + object.pixels_behind_robot);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::Values("conveyor", "handover", "random"),
                         [](const auto& scene) { return scene.param; });

void expect_refused(const SimulationOptions& options, const std::string& word) {
  try {
    const Simulation simulation("conveyor", options);
    ADD_FAILURE() << "taken: " << word;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(SimulationInput, RefusesWhatMakesNoSense) {
  PENUMBRA_REQUIRE_SIMULATION();
  EXPECT_THROW(Simulation("conveyer", {}), InputError);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan, 1e9}) {
    expect_refused({.joint_sigma = bad}, "joint_sigma");
    expect_refused({.joint_latency = bad}, "joint_latency");
    expect_refused({.belt_jitter = bad}, "belt_jitter");
    expect_refused({.duration = bad}, "duration");
    expect_refused({.frame_rate = bad}, "frame_rate");
    expect_refused({.depth = {.quadratic = bad}}, "quadratic");
    expect_refused({.depth = {.edge_holes = bad}}, "edge_holes");
  }
  expect_refused({.duration = 0.01}, "one frame");
  expect_refused({.frame_rate = 0.1}, "frame_rate (--rate)");  // of the scene's own five seconds
  EXPECT_THROW(Simulation("random", {.joint_latency = 0.1}), InputError) << "nothing moves there";
  expect_refused({.depth = {.edge_holes = 0.6, .edge_mixed = 0.6}}, "edge_mixed");
}

}  // namespace
}  // namespace penumbra::test
