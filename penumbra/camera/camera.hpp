// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/distortion.hpp>
#include <penumbra/camera/intrinsics.hpp>

namespace penumbra {

/// The sensor's range, metres: depths outside of it are no measurements. It does not limit what is
/// rendered.
struct DepthRange {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
};

/// A calibrated depth camera, without its pose.
struct Camera {
  Intrinsics intrinsics;  ///< of the image as received
  Distortion distortion;  ///< of the image as received; none if it is already rectified
  DepthRange range;
  std::string frame_id;  ///< the optical frame; may be empty

  /// Returns itself. Throws InputError, with the values, unless 0 <= near < far.
  const Camera& check() const {
    if (!(range.near >= 0 && range.near < range.far))
      throw InputError("camera: the range from " + std::to_string(range.near) + " to " +
                       std::to_string(range.far) + " metres must be 0 <= near < far");
    return *this;
  }
};

}  // namespace penumbra
