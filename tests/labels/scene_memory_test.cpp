// SPDX-License-Identifier: Apache-2.0
// What a camera has seen before the robot came tells real things from fringe.
#include "scene.hpp"

#include <penumbra/labels/scene_memory.hpp>

namespace penumbra::test {
namespace {

/// A thing in columns [200, 230) before a wall, and a robot that comes beside it.
class Memory : public IsaTest {
 protected:
  static constexpr int width = 320, height = 96;
  static constexpr float near = 1.0f, wall = 2.5f;  // metres
  static constexpr std::int64_t second = 1'000'000'000;

  explicit Memory(double seconds = 60.0) {
    rule_.scene_memory = seconds;
    memory_.emplace(width, height, rule_, GetParam());
    classifier_.emplace(width, height, rule_, GetParam());
    std::fill_n(scene_.metres.data(), scene_.metres.size(), wall);
  }

  void measure(int u0, int u1, float z) {
    for (const auto [u, v] : each_pixel(u0, 20, u1, 76)) scene_.metres(u, v) = z;
  }
  /// The robot is in columns [u0, u1); none if they are equal.
  void move_robot(int u0, int u1, float z = near) {
    std::fill_n(scene_.robot.data(), scene_.robot.size(), 0.0f);
    for (const auto [u, v] : each_pixel(u0, 20, u1, 76)) scene_.robot(u, v) = z;
    scene_.mark_tiles();
    measure(u0, u1, z);
  }
  /// Labels the next frame, three seconds later, and returns how many pixels are fringe.
  std::size_t fringe(std::int64_t later = 3 * second) {
    if (has_stamps) stamp_ = stamp_.value_or(0) + later;
    memory_->begin(T_root_camera, stamp_);
    const LabelView labels =
        classifier_->classify(scene_.view(), scene_.metres.view(), memory_->depth());
    memory_->update(scene_.view(), scene_.metres.view(), labels);
    return count(labels, Label::fringe);
  }
  /// The thing stands alone, then the robot is at it.
  std::size_t fringe_of_thing(std::int64_t later = 3 * second) {
    measure(200, 230, near);
    move_robot(0, 0);
    EXPECT_EQ(fringe(), 0u);
    move_robot(140, 200);
    return fringe(later);
  }

  static constexpr std::size_t thing = 30 * 56;

  bool has_stamps = true;
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  LabelRule rule_;
  std::optional<SceneMemory> memory_;
  std::optional<Classifier> classifier_;
  Scene scene_{width, height};
  std::optional<std::int64_t> stamp_;
};

class ShortMemory : public Memory {
 protected:
  ShortMemory() : Memory(10.0) {}
};

PENUMBRA_FOR_EACH_ISA(Memory);
PENUMBRA_FOR_EACH_ISA(ShortMemory);

TEST_P(Memory, KeepsAThingThatWasThereBefore) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  has_stamps = false;
  stamp_.reset();
  memory_->forget();
  EXPECT_EQ(fringe_of_thing(), 0u);
}

TEST_P(Memory, TellsWhatTheSensorCarriesFromThings) {
  move_robot(0, 0);
  EXPECT_EQ(fringe(), 0u);
  move_robot(140, 200);
  measure(200, 212, near);  // carried past the outline
  EXPECT_EQ(fringe(), 12u * 56u);
}

TEST_P(Memory, AThingThatComesWithTheRobotIsFringe) {
  move_robot(0, 0);
  EXPECT_EQ(fringe(), 0u);
  measure(200, 230, near);
  move_robot(140, 200);
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, AThingNearerOrFartherThanBeforeIsAnother) {
  measure(200, 230, near + 0.03f);
  move_robot(0, 0);
  EXPECT_EQ(fringe(), 0u);
  measure(200, 230, near);
  move_robot(140, 200);
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, LastsWhileTheRobotPassesBeforeIt) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  move_robot(180, 260, 0.5f);
  EXPECT_EQ(fringe(), 0u);
  measure(180, 260, wall);
  measure(200, 230, near);
  move_robot(140, 200);
  EXPECT_EQ(fringe(), 0u);
}

TEST_P(Memory, EndsWhereTheRobotWas) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  measure(140, 200, wall);
  move_robot(180, 260);  // at the thing's own depth: it has been taken or pushed
  EXPECT_EQ(fringe(), 0u);
  measure(180, 260, wall);
  measure(200, 230, near);
  move_robot(140, 200);
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, EndsWhenTheThingIsTakenAway) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  measure(200, 230, wall);
  EXPECT_EQ(fringe(), 0u);
  measure(200, 230, near);
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, EndsWithAMovedCameraOrClock) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  T_root_camera.translation().x() += 0.005;
  EXPECT_EQ(fringe(), thing);
  EXPECT_EQ(fringe_of_thing(), 0u);
  EXPECT_EQ(fringe(-second), thing);
}

TEST_P(Memory, OfAViewThatHasChangedIsLost) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  for (float& z : std::span(scene_.metres.data(), scene_.metres.size()))
    z -= z == wall ? 0.5f : 0.0f;
  EXPECT_EQ(fringe(), 0u) << "of frames before";
  EXPECT_EQ(fringe(), thing) << "the base has driven";
}

TEST_P(ShortMemory, Ages) {
  EXPECT_EQ(fringe_of_thing(8 * second), 0u);
  EXPECT_EQ(fringe(3 * second), 0u) << "of the frames until now";
  EXPECT_EQ(fringe(3 * second), thing);
}

/// All targets remember the same as plain loops, in images of any size.
TEST(MemoryTwins, RememberTheSame) {
  auto random = seeded_random(21);
  for (int i = 0; i < 60; ++i) {
    const int w = 1 + int(random() % 300), h = 1 + int(random() % 60);
    LabelRule rule;
    rule.fringe_reach = 1 + int(random() % 20);
    rule.range = {0.45, 1.4};
    Image<std::uint16_t> expected(w, h, SceneMemory::none);
    std::vector<SceneMemory> memories;
    for (const std::string& isa : simd_target_names()) memories.emplace_back(w, h, rule, isa);
    Classifier classifier(w, h, rule);
    const auto e = [&](float z) {
      return float(rule.tolerance.a) + float(rule.tolerance.c) * z * z;
    };
    for (int frame = 0; frame < 6; ++frame) {
      const Scene scene = random_scene(w, h, random);
      const Image<std::uint16_t> measured = scene.millimetres();
      const LabelView labels = classifier.classify(scene.view(), measured.view());
      const MeasuredRange range(rule.range.near, rule.range.far);
      const auto is_near = [&](int u, int v) {
        const int tile_u = u / scene.tiles.tile_width, tile_v = v / TileMask::tile_height;
        const auto tiles = [&](int size) { return (rule.fringe_reach + size - 1) / size; };
        for (const auto [x, y] : each_pixel(scene.robot))
          if (scene.robot(x, y) > 0.0f &&
              std::abs(x / scene.tiles.tile_width - tile_u) <= tiles(scene.tiles.tile_width) &&
              std::abs(y / TileMask::tile_height - tile_v) <= tiles(TileMask::tile_height))
            return true;
        return false;
      };
      int away = 0, changed = 0;
      for (int v0 = 0; v0 < h; v0 += TileMask::tile_height)
        for (int u0 = 0; u0 < w; u0 += scene.tiles.tile_width) {
          const int u1 = std::min(w, u0 + scene.tiles.tile_width),
                    v1 = std::min(h, v0 + TileMask::tile_height);
          const bool is_robots = is_near(u0, v0);
          int both = 0, others = 0;
          for (const auto [u, v] : each_pixel(u0, v0, u1, v1)) {
            std::uint16_t& known = expected(u, v);
            const float d = metres_of(measured(u, v), range), z = scene.robot(u, v);
            const float m = 0.001f * float(known);
            const bool is_known = known != SceneMemory::none;
            if (is_robots && is_known) {
              const bool is_other = labels.labels(u, v) == std::uint8_t(Label::clear) && d > 0.0f &&
                                    std::abs(d - m) > 0.6f * e(m);
              if (is_other || (z > 0.0f && std::abs(z - m) <= 3.0f * e(m)))
                known = SceneMemory::none;
            }
            if (is_robots) continue;
            if (v == v0 && d > 0.0f && is_known) ++both, others += std::abs(d - m) > e(d);
            if (d > 0.0f) known = measured(u, v);
          }
          away += !is_robots;
          changed += 2 * others > both;
        }
      if (frame > 0 && 2 * changed > away)
        std::fill_n(expected.data(), expected.size(), SceneMemory::none);
      for (SceneMemory& memory : memories) {
        memory.begin(Eigen::Isometry3d::Identity(), std::nullopt);
        memory.update(scene.view(), measured.view(), labels);
        for (const auto [u, v] : each_pixel(expected))
          ASSERT_EQ(memory.depth()(u, v), expected(u, v))
              << u << ", " << v << " of frame " << frame;
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::test
