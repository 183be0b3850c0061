// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/registration.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/assembly/assembled_frame.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::io {

/// Decodes the depth images of assembled frames, checks their size, and registers them to the
/// judged camera if they are of another camera.
class DepthInput {
 public:
  explicit DepthInput(const JudgedCameras& cameras);

  /// Sets the frame's depth; none for a camera without depth. An image that cannot be used makes
  /// its source_status bad_depth. Returns why the image's message cannot be decoded, or an empty
  /// text.
  [[nodiscard]] std::string read(AssembledFrame& job);

 private:
  [[nodiscard]] std::string decode(const KeptImage& image, SharedDepth& depth) const;
  [[nodiscard]] std::string bring(const AssembledFrame& from, SharedDepth& depth);

  bool has_depth_;
  int width_, height_;  // of the depth images
  std::optional<DepthRegistration> registration_;
  std::optional<double> scale_;  // metres per unit
  Image<float> z_of_ray_;        // as in FrameReader
};

}  // namespace penumbra::io
