// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/labels/rule.hpp>

namespace penumbra {
namespace labelling {

/// Pixels u0 <= u < u1, v0 <= v < v1 of a frame and of what is known of its scene.
struct SceneTile {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  bool is_near = false;               ///< the robot
  ImageView<const float> robot = {};  ///< virtual depth
  ImageView<const std::uint8_t> labels = {};
  ImageView<std::uint16_t> known = {};
};

/// Takes a tile away from the robot, and returns whether most of it differs from what was known; or
/// forgets what a tile near to the robot contradicts.
using UpdateSceneTile = bool (*)(const Rule&, const SceneTile&, const DepthView& measured);

}  // namespace labelling

/// What a camera that stands still measured away from the robot (LabelRule::scene_memory). With
/// stamps each part of the image is visited every two seconds, without in each frame.
class SceneMemory {
 public:
  static constexpr std::uint16_t none = saturated_depth;

  /// `isa` as in RendererOptions.
  SceneMemory(int width, int height, const LabelRule& rule, const std::string& isa = {});

  /// Begins a frame. Forgets all if the camera has moved or the clock was set.
  void begin(const Eigen::Isometry3d& T_root_camera, std::optional<std::int64_t> stamp);
  /// Takes what a labelled frame measured away from the robot. Near the robot it forgets what now
  /// differs, what the robot reaches, and what is too old; all, if most of the image differs.
  void update(const VirtualDepthView& virtual_depth, const DepthView& measured,
              const LabelView& labels);
  void forget();

  /// Returns depths in millimetres; `none` where nothing is known.
  [[nodiscard]] ImageView<const std::uint16_t> depth() const { return depth_.view(); }

 private:
  labelling::Rule rule_;
  labelling::UpdateSceneTile update_tile_;
  int reach_;           // pixels
  std::int64_t lasts_;  // nanoseconds
  Image<std::uint16_t> depth_;
  bool is_empty_ = true;
  TileMask robot_;                     // the tiles in which it is, in rows that are visited
  std::vector<std::int64_t> visited_;  // when each row of tiles was
  std::vector<std::uint64_t> known_;   // bits of its tiles
  std::vector<std::array<std::int64_t, 64>> taken_;  // when its tiles were
  std::optional<Eigen::Isometry3d> T_root_camera_;
  bool is_moving_ = false;  // the camera, in this frame
  std::optional<std::int64_t> stamp_;
};

}  // namespace penumbra
