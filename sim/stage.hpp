// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/files/png.hpp>
#include <sim/arm.hpp>
#include <sim/scene.hpp>

namespace penumbra::sim {

/// A camera and its pose.
struct Viewpoint {
  Intrinsics intrinsics;  ///< fx = fy: MuJoCo's renderer has square pixels
  Eigen::Isometry3d T_base_camera;
};

/// The pixels u0 <= u < u1, v0 <= v < v1 of an image.
struct Window {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  [[nodiscard]] bool empty() const { return u0 >= u1 || v0 >= v1; }
};

/// Places and draws the arm and a scene's parts with MuJoCo.
class Stage {
 public:
  /// `folder` has the files that Arm wrote. Images may be up to the size of `largest`. Throws
  /// InputError if the machine has no OpenGL.
  Stage(const Arm& arm, const SceneDescription& scene, const std::filesystem::path& folder,
        const Intrinsics& largest);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Places all parts. `joints` in the order of Robot::variables().
  void place(std::span<const double> joints, std::span<const Eigen::Isometry3d> parts);

  /// Draws the colour image.
  void draw_color(const Viewpoint& view, Image<Rgb8>& color);

  /// Draws the nearest id among those that `shown` accepts, and its depth along the optical axis in
  /// metres; 0 if there is nothing. Ids are those of SimFrame::ids, 0 for the background. Null
  /// images are not drawn. Pixels outside of `window` are not changed.
  void draw_ids(const Viewpoint& view, const std::function<bool(std::int32_t)>& shown,
                const Window& window, Image<std::int32_t>* ids, Image<float>* depth);

  /// Returns a window that contains all pixels of one id.
  [[nodiscard]] Window window_of(const Viewpoint& view, std::int32_t id) const;

 private:
  struct Drawing;
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace penumbra::sim
