// SPDX-License-Identifier: Apache-2.0
// What a camera has seen before the robot came tells real things from fringe.
#include "scene.hpp"

#include <penumbra/labels/scene_memory.hpp>

namespace penumbra::test {
namespace {

/// A thing in columns [200, 230) before a wall, and a robot that comes next to it.
class Memory : public IsaTest {
 protected:
  static constexpr int width = 320, height = 96;
  static constexpr float near = 1.0f, wall = 2.5f;  // metres
  static constexpr std::int64_t second = 1'000'000'000;

  Memory() {
    remember(60.0);
    classifier_.emplace(width, height, rule_, GetParam());
    std::fill_n(scene_.metres.data(), scene_.metres.size(), wall);
  }

  void remember(double seconds) {
    rule_.scene_memory = seconds;
    memory_.emplace(width, height, rule_, GetParam());
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
    stamp_ += later;
    memory_->update(T_root_camera, stamp_, scene_.view(), scene_.metres.view());
    return count(classifier_->classify(scene_.view(), scene_.metres.view(), memory_->depth()),
                 Label::fringe);
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

  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  LabelRule rule_;
  std::optional<SceneMemory> memory_;
  std::optional<Classifier> classifier_;
  Scene scene_{width, height};
  std::int64_t stamp_ = 0;
};

PENUMBRA_FOR_EACH_ISA(Memory);

TEST_P(Memory, KeepsAThingThatWasThereBefore) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  memory_->forget();
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, TellsWhatTheSensorCarriesFromThings) {
  move_robot(0, 0);
  EXPECT_EQ(fringe(), 0u);
  move_robot(140, 200);
  measure(200, 212, near);  // carried past the outline
  EXPECT_EQ(fringe(), 12u * 56u);
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

TEST_P(Memory, EndsWhenTheThingIsTakenAway) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  measure(200, 230, wall);
  EXPECT_EQ(fringe(), 0u);
  measure(200, 230, near);
  EXPECT_EQ(fringe(), thing);
}

TEST_P(Memory, OfWhatHasGoneAroundIsNotTakenForWhatTheSensorCarries) {
  for (const auto [u, v] : each_pixel(80, 0, 300, height)) scene_.metres(u, v) = near;
  move_robot(0, 0);
  EXPECT_EQ(fringe(), 0u);
  std::fill_n(scene_.metres.data(), scene_.metres.size(), wall);
  move_robot(140, 200);
  measure(200, 212, near);  // carried past the outline
  EXPECT_EQ(fringe(), 12u * 56u);
}

TEST_P(Memory, OfWhatWasSeenOnceAndChangesIsNone) {
  const auto fringe_after = [&](int times) {
    memory_->forget();
    move_robot(0, 0);
    measure(200, 230, wall);
    EXPECT_EQ(fringe(), 0u);
    measure(200, 230, near);  // it comes
    for (int i = 0; i < times; ++i) EXPECT_EQ(fringe(), 0u);
    move_robot(140, 200);
    return fringe();
  };
  EXPECT_EQ(fringe_after(1), thing);
  EXPECT_EQ(fringe_after(2), 0u);
}

TEST_P(Memory, EndsWithAMovedCameraOrClock) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  T_root_camera.translation().x() += 0.005;
  EXPECT_EQ(fringe(), thing);
  EXPECT_EQ(fringe_of_thing(), 0u);
  EXPECT_EQ(fringe(-5 * second), thing);
}

TEST_P(Memory, OfAViewThatHasChangedIsLost) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  for (float& z : std::span(scene_.metres.data(), scene_.metres.size()))
    z -= z == wall ? 0.5f : 0.0f;
  EXPECT_EQ(fringe(), thing) << "the base has driven";
}

TEST_P(Memory, Ages) {
  remember(10.0);
  EXPECT_EQ(fringe_of_thing(8 * second), 0u);
  EXPECT_EQ(fringe(3 * second), thing);
}

TEST_P(Memory, EndsSoonWhereARobotTakesTheThing) {
  EXPECT_EQ(fringe_of_thing(), 0u);
  for (int i = 0; i < 9; ++i) {  // 0.3 s at 30 Hz
    move_robot(140, 260);
    EXPECT_EQ(fringe(second / 30), 0u);
  }
  measure(140, 260, wall);
  measure(200, 230, near);
  move_robot(140, 200);
  EXPECT_EQ(fringe(second / 30), thing);
}

/// The memory of frames three seconds apart as plain loops over tiles.
class PlainMemory {
 public:
  PlainMemory(int width, int height, const LabelRule& rule)
      : depth(width, height, SceneMemory::none), rule_(rule) {}

  template <typename T>
  void update(const Scene& scene, ImageView<const T> measured) {
    const int side = scene.tiles.tile_width, tall = TileMask::tile_height;
    const int columns = (depth.width() + side - 1) / side;
    const MeasuredRange range(rule_.range.near, rule_.range.far);
    for (int v0 = 0; v0 < depth.height(); v0 += tall)
      for (int u0 = 0; u0 < depth.width(); u0 += side) {
        const int tile = v0 / tall * columns + u0 / side;
        const bool is_near = near(scene, u0 / side, v0 / tall);
        const bool is_known = !known_.insert({tile, false}).second && known_[tile];
        int both = 0, others = 0;
        for (const auto [u, v] : each_pixel(u0, v0, std::min(u0 + side, depth.width()),
                                            std::min(v0 + tall, depth.height()))) {
          std::uint16_t& m = depth(u, v);
          const float d = metres_of(measured(u, v), range), z = scene.robot(u, v);
          const float before = 0.001f * float(m & (labelling::seen_once - 1)), off = d - before;
          if (is_near && m != SceneMemory::none &&
              ((d > 0.0f && off > 0.6f * e(before)) ||
               (z > 0.0f && std::abs(z - before) <= 3.0f * e(before))))
            m = SceneMemory::none;
          if (is_near) continue;
          const bool is_both = d > 0.0f && m != SceneMemory::none;
          const bool is_same = is_both && std::abs(off) <= e(d);
          both += v == v0 && is_both;
          others += v == v0 && is_both && !is_same;
          m = SceneMemory::none;
          if (d > 0.0f) m = std::uint16_t(std::nearbyint(1000.0f * d));
          if (d > 0.0f && is_known && !is_same) m |= labelling::seen_once;
        }
        if (is_near) continue;
        away_ += is_known;
        changed_ += is_known && 2 * others > both;
        known_[tile] = true;
      }
    const int rows = (depth.height() + tall - 1) / tall;
    if (4 * away_ < rows * (depth.width() / side + 1)) return;
    if (2 * changed_ > away_) {
      std::fill_n(depth.data(), depth.size(), SceneMemory::none);
      known_.clear();
    }
    away_ = changed_ = 0;
  }

  Image<std::uint16_t> depth;

 private:
  [[nodiscard]] float e(float z) const {
    return float(rule_.tolerance.a) + float(rule_.tolerance.c) * z * z;
  }
  [[nodiscard]] bool near(const Scene& scene, int i, int j) const {
    const int reach = std::max(rule_.fringe_reach, 40);
    const auto tiles = [&](int size) { return (reach + size - 1) / size; };
    for (const auto [u, v] : each_pixel(scene.robot))
      if (scene.robot(u, v) > 0.0f &&
          std::abs(u / scene.tiles.tile_width - i) <= tiles(scene.tiles.tile_width) &&
          std::abs(v / TileMask::tile_height - j) <= tiles(TileMask::tile_height))
        return true;
    return false;
  }

  LabelRule rule_;
  std::map<int, bool> known_;
  int away_ = 0, changed_ = 0;
};

TEST(MemoryTwins, RememberWhatPlainLoopsDo) {
  auto random = seeded_random(21);
  std::size_t remembered = 0;
  for (int i = 0; i < 40; ++i) {
    const int width = 1 + int(random() % 400), height = 1 + int(random() % 160);
    LabelRule rule;
    rule.range = {0.45, 1.52};
    PlainMemory plain(width, height, rule);
    std::vector<SceneMemory> memories;
    for (const std::string& isa : simd_target_names())
      memories.emplace_back(width, height, rule, isa);
    for (int frame = 1; frame < 6; ++frame) {
      Scene scene = random_scene(width, height, random);
      std::fill_n(scene.robot.data(), scene.robot.size(), 0.0f);
      if (frame > 1)
        for (const auto [u, v] : each_pixel(width / 2, height / 2, width * 2 / 3, height * 2 / 3))
          scene.robot(u, v) = 0.8f;
      scene.mark_tiles();
      const Image<std::uint16_t> millimetres = to_millimetres(scene.metres);
      const bool is_float = i % 2 == 0;
      DepthView measured = std::as_const(scene.metres).view();
      if (!is_float) measured = millimetres.view();
      std::visit([&](const auto& view) { plain.update(scene, view); }, measured);
      for (SceneMemory& memory : memories) {
        memory.update(Eigen::Isometry3d::Identity(), 3'000'000'000 * frame, scene.view(), measured);
        for (const auto [u, v] : each_pixel(plain.depth))
          ASSERT_EQ(memory.depth()(u, v), plain.depth(u, v)) << u << ", " << v << ", " << frame;
      }
      remembered +=
          std::size_t(std::count_if(plain.depth.data(), plain.depth.data() + plain.depth.size(),
                                    [](auto m) { return m != SceneMemory::none; }));
    }
  }
  EXPECT_GT(remembered, 100'000u);
}

}  // namespace
}  // namespace penumbra::test
