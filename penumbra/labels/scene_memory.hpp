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

/// Pixels u0 <= u < u1, v0 <= v < v1 of what is known of a scene.
struct SceneTile {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  bool is_near = false;  ///< the robot
  bool is_new = false;   ///< nothing is known of it
  ImageView<std::uint16_t> known = {};
};

/// Takes what is measured in a tile away from the robot, and returns whether most of it differs
/// from what was known; or forgets what a tile near the robot contradicts.
using UpdateSceneTile = bool (*)(const Rule&, const SceneTile&, ImageView<const float> robot,
                                 const DepthView& measured);

}  // namespace labelling

/// What a camera that stands still measured away from the robot (LabelRule::scene_memory). What
/// differs from before counts once it is seen again.
class SceneMemory {
 public:
  static constexpr std::uint16_t none = saturated_depth;

  /// `isa` as in RendererOptions.
  SceneMemory(int width, int height, const LabelRule& rule, const std::string& isa = {});

  /// Four times a second, takes what a frame measures away from the robot, and forgets what is too
  /// old and, near the robot, what it now sees past or the robot reaches; all, if the camera has
  /// moved, the clock was set or most of the view differs.
  void update(const Eigen::Isometry3d& T_root_camera, std::int64_t stamp,
              const VirtualDepthView& robot, const DepthView& measured);
  void forget();

  /// Returns depths in millimetres, with labelling::seen_once; `none` where nothing is known.
  [[nodiscard]] ImageView<const std::uint16_t> depth() const { return depth_.view(); }

 private:
  void update_row(std::size_t row, const VirtualDepthView& robot, const DepthView& measured);

  labelling::Rule rule_;
  labelling::UpdateSceneTile update_tile_;
  int reach_;            // pixels
  std::uint64_t lasts_;  // nanoseconds
  Image<std::uint16_t> depth_;
  std::optional<Eigen::Isometry3d> T_root_camera_;
  std::int64_t stamp_ = 0;
  bool is_empty_ = true;
  int away_ = 0, changed_ = 0;                       // tiles that were taken lately
  TileMask robot_;                                   // where it is, in rows that are visited
  std::vector<std::uint64_t> known_;                 // bits of the tiles of a row
  std::vector<std::array<std::int64_t, 64>> taken_;  // their stamps
};

}  // namespace penumbra
