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

  /// Sets the frame's depth, which refers to its image and to this until the next call; none for a
  /// camera without depth. An image
  /// that cannot be used makes its source_status bad_depth. Returns why the image's message cannot
  /// be decoded, or an empty text.
  [[nodiscard]] std::string read(AssembledFrame& job);

 private:
  [[nodiscard]] std::string decode(const KeptImage& image, DepthView& depth);
  [[nodiscard]] std::string bring(const AssembledFrame& from, DepthView& depth);

  bool has_depth_;
  int width_, height_;  // of the depth images
  std::optional<DepthRegistration> registration_;
  std::optional<double> scale_;  // metres per unit
  Image<float> z_of_ray_;        // as in FrameReader
  DecodedDepth decoded_;
  SharedDepth scaled_, along_z_;
};

}  // namespace penumbra::io
