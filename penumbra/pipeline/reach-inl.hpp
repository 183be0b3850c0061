// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Where links of unknown pose can be: a ball in the optical frame, metres. Its radius may be
/// infinite.
struct Reach {
  std::size_t link;  ///< the first of the links; it is not drawn
  Eigen::Vector3d centre;
  double radius;
};

/// Returns, of each link, the largest distance of geometry of it and of its descendants from its
/// frame's origin within the joint limits, metres. Infinite for a planar, floating or unlimited
/// prismatic joint below it.
[[nodiscard]] std::vector<double> reach_of_links(const Robot& robot);

/// Returns how far a joint moves its child's origin at most, metres.
[[nodiscard]] double travel_of(const Joint& joint);

/// Draws the near side of each ball into a virtual depth image, as the link's number. A camera
/// inside a ball sees it at DepthRenderer::near_plane.
void draw_reaches(std::span<const Reach> reaches, const Intrinsics& intrinsics,
                  ImageView<float> depth, ImageView<std::uint16_t> links, TileMask& touched);

/// Returns the labels with `unknown` in place of `occluded` and `beyond` where a ball is the
/// nearest. `copy` holds the result.
[[nodiscard]] LabelView unknown_in_reaches(const LabelView& labels,
                                           const ImageView<const std::uint16_t>& links,
                                           std::span<const Reach> reaches,
                                           Image<std::uint8_t>& copy);

}  // namespace penumbra
