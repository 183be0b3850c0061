// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/required.hpp"
#include "../support/test.hpp"

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

#include <sim/simulation.hpp>

/// Skips the running test where the build has no simulation.
#define PENUMBRA_REQUIRE_SIMULATION() \
  if (!penumbra::test::has_simulation()) GTEST_SKIP() << "skipped: no MuJoCo"

namespace penumbra::test {

inline bool has_simulation() { return is_there(!sim::Simulation::scenes().empty(), "simulation"); }

/// Tests with MuJoCo, and those with true depths and with a depth camera's noise.
class SimulationTest : public testing::Test {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_SIMULATION(); }
};
class BothDepths : public SimulationTest, public testing::WithParamInterface<bool> {};
inline const auto depth_name = [](const auto& test) {
  return std::string(test.param ? "Noisy" : "Exact");
};

inline constexpr double degree = std::numbers::pi / 180.0;  // rad

[[nodiscard]] inline double percent(std::size_t part, std::size_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(all, 1));
}

/// Returns the value that a share of all is not larger than.
[[nodiscard]] inline double quantile(std::vector<double> all, double share) {
  std::sort(all.begin(), all.end());
  return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
}

/// Whether MuJoCo's id is one of the robot's links.
[[nodiscard]] inline bool is_robot(std::int32_t id) { return id > 0 && id < sim::first_object_id; }

/// Returns the verdict by the thresholds' defaults.
[[nodiscard]] inline Verdict verdict_of(double hidden) {
  const TargetThresholds t;
  return hidden > t.hidden_enter    ? Verdict::hidden
         : hidden > t.partial_enter ? Verdict::partial
                                    : Verdict::visible;
}

/// Returns an object as a target: a ball as a point, anything else as a box.
[[nodiscard]] inline Target target_of(const sim::ObjectTruth& object) {
  Target target;
  target.name = object.name;
  if (object.solid.kind == sim::Solid::ball)
    target.shape = PointTarget{object.T_base_object.translation(), 0.5 * object.solid.size.x(),
                               ReferenceFrame::root()};
  else
    target.shape = BoxTarget{object.T_base_object, object.solid.size, ReferenceFrame::root()};
  return target;
}

/// Returns depth in metres.
[[nodiscard]] inline Image<float> in_metres(const Image<std::uint16_t>& millimetres) {
  Image<float> depth(millimetres.width(), millimetres.height());
  std::transform(millimetres.data(), millimetres.data() + millimetres.size(), depth.data(),
                 [](std::uint16_t z) { return metres_of(z); });
  return depth;
}

/// True depths, true joints.
[[nodiscard]] inline sim::SimulationOptions without_noise(std::uint64_t seed) {
  return {.seed = seed, .depth = {}};
}

/// Depths with a depth camera's noise, or true ones; no colours.
[[nodiscard]] inline sim::SimulationOptions without_color(std::uint64_t seed, bool noisy) {
  return {
      .seed = seed, .depth = noisy ? sim::DepthNoise::d415() : sim::DepthNoise(), .color = false};
}

}  // namespace penumbra::test
