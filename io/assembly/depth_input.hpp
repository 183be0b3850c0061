// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/registration.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/ros/image_codec.hpp>

namespace penumbra::io {

/// Makes depth images of messages what the pipeline takes: of the judged camera's size, brought to
/// it where they are another camera's.
class DepthInput {
 public:
  /// `depth_camera`: the depth images' own, if they are to be brought to `judged`.
  DepthInput(const Camera& judged, const std::optional<Camera>& depth_camera);

  /// Answers what is wrong with the message's image, one line, or nothing. `depth` refers to the
  /// payload or to this, until the next call.
  template <typename M>
  [[nodiscard]] std::string decode(const M& message, DepthView& depth);

  /// Answers why an image is not one of the camera, or nothing; it is empty then.
  [[nodiscard]] std::string check_size(DepthView& depth) const;

  /// Whether images have to be brought to the judged camera.
  [[nodiscard]] bool is_of_other_camera() const { return registration_.has_value(); }

  /// Brings an image there, as TF says. Answers likewise.
  [[nodiscard]] std::string bring(const TransformAnswer& T_judged_depth, DepthView& depth);

 private:
  int width_, height_;  // of the depth images
  std::optional<DepthRegistration> registration_;
  DecodedDepth decoded_;
};

}  // namespace penumbra::io
