// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include <penumbra/camera/distortion.hpp>
#include <penumbra/camera/intrinsics.hpp>

namespace penumbra {

/// The sensor's own range, metres: depths outside of it are no measurements. It limits what the
/// sensor can say, not what is rendered.
struct DepthRange {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
};

/// A calibrated depth camera: what its images are like, not where it is.
struct Camera {
  Intrinsics intrinsics;  ///< of the image as it comes
  Distortion distortion;  ///< of the image as it comes; none where it is already rectified
  DepthRange range;
  std::string frame_id;  ///< the optical frame; may be empty

  /// Throws InputError, with the values it got, unless 0 <= near < far.
  void check() const;
};

}  // namespace penumbra
