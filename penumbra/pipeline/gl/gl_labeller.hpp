// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/occlusion/labels.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/pixel_rectangle.hpp>

namespace penumbra {

/// A frame's labels as the device made them.
struct DeviceLabels {
  LabelView image;
  /// For each box that was asked for: how many pixels inside of the image have each label.
  std::span<const std::array<std::size_t, label_count>> boxes;
};

/// Draws the robot and labels the sensor's image on the device of the gl backend: the sensor's
/// depth goes there, and 8-bit labels and counts come back, of the robot's part of the image alone.
/// The rule is LabelRule's, bit for bit: labels differ from Classifier's only where the virtual
/// depth does. Pinhole images only. One instance serves one thread at a time.
class GlLabeller {
 public:
  static constexpr std::size_t max_boxes = 256;
  static constexpr int max_pending = 3;

  /// Of `options` the gl_device counts. Throws InputError as make_depth_renderer and Classifier do.
  GlLabeller(const Intrinsics& intrinsics, std::span<const Body> bodies, const LabelRule& rule,
             const RendererOptions& options = {});
  ~GlLabeller();
  GlLabeller(const GlLabeller&) = delete;
  GlLabeller& operator=(const GlLabeller&) = delete;

  /// Starts a frame: the bodies at their poses, the sensor's image of the camera's size, both read
  /// before it returns, and boxes in which to count. Throws std::logic_error with max_pending
  /// frames not collected, more than max_boxes boxes, poses that are not as many as the bodies or
  /// an image of another size, DeviceError where the device fails or has failed: make a new
  /// one.
  void submit(std::span<const Eigen::Isometry3d> T_camera_body, const DepthView& measured,
              std::span<const gl::PixelRectangle> boxes = {});

  /// Waits for the oldest frame; valid until the max_pending-th submit() after its own. Throws
  /// std::logic_error without a frame, DeviceError as submit() does.
  [[nodiscard]] DeviceLabels collect();

  [[nodiscard]] const RendererInfo& info() const;
  [[nodiscard]] std::size_t triangle_count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
