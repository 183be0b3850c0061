// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/registration.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/ros/image_codec.hpp>

namespace penumbra::io {

/// Converts depth images of messages to the input of the pipeline: checks their size, and registers
/// them to the judged camera if they are of another camera.
class DepthInput {
 public:
  /// `depth_camera`: the camera of the depth images, if they have to be registered to `judged`.
  DepthInput(const Camera& judged, const std::optional<Camera>& depth_camera);

  /// Decodes an image. Returns what is wrong with it, one line, or an empty text. `depth` views the
  /// message's data or this object until the next call.
  template <typename M>
  [[nodiscard]] std::string decode(const M& message, DepthView& depth);

  /// Returns why an image does not have the camera's size, or an empty text. Clears `depth` if the
  /// size is wrong.
  [[nodiscard]] std::string check_size(DepthView& depth) const;

  /// Returns whether images have to be registered to the judged camera.
  [[nodiscard]] bool is_of_other_camera() const { return registration_.has_value(); }

  /// Registers an image to the judged camera by TF. Returns why that fails, or an empty text.
  [[nodiscard]] std::string bring(const TransformAnswer& T_judged_depth, DepthView& depth);

 private:
  int width_, height_;  // of the depth images
  std::optional<DepthRegistration> registration_;
  DecodedDepth decoded_;
};

}  // namespace penumbra::io
