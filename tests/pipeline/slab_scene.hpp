// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/nanoseconds.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

/// A robot of two boxes before the camera, whose depth a formula tells. The camera sits in the
/// root; "slab" moves along the optical axis with joint "slide", "plate" stands still beside it.
inline constexpr double slab_depth = 0.95;  // of its near face at slide = 0, metres
inline constexpr double wall_depth = 3.0;   // of what stands behind everything, metres

/// Metres at 1 m: float32 and the renderer's own formula.
inline constexpr double depth_tolerance = 1e-5;

inline constexpr auto unknown_label = static_cast<std::uint8_t>(Label::unknown);

[[nodiscard]] std::string slab_urdf(const std::string& more = {});
[[nodiscard]] Robot slab_robot();

/// Its principal point is off the centre, and no box edge meets a pixel centre.
[[nodiscard]] Camera slab_camera();

/// Nothing but the tolerance: 0.02 m everywhere, no clean-up.
[[nodiscard]] PipelineConfig plain_config(Backend backend = Backend::cpu);

struct Seen {
  double depth = 0.0;  ///< metres; 0: no robot
  int link = 0;        ///< link image value
};

/// Another box of the scene, with axes along the root's.
struct SlabBox {
  Eigen::Vector3d centre, size;  ///< metres, in the root's frame
  int link = 0;                  ///< link image value
};

/// What the ray from the root's origin meets first, by intersecting boxes.
[[nodiscard]] Seen cast(const Eigen::Vector3d& ray, double slide,
                        const std::vector<SlabBox>& more = {});

/// Metres: the robot itself, and the wall where it is not.
[[nodiscard]] Image<float> scene_depth(const Camera& camera, double slide,
                                       const std::vector<SlabBox>& more = {});

[[nodiscard]] Image<std::uint16_t> to_millimetres(const Image<float>& metres);

/// A copy of a view.
template <typename T>
[[nodiscard]] std::vector<T> pixels_of(ImageView<const T> view) {
  std::vector<T> pixels;
  for (int v = 0; v < view.height; ++v)
    pixels.insert(pixels.end(), view.row(v), view.row(v) + view.width);
  return pixels;
}

}  // namespace penumbra::test
