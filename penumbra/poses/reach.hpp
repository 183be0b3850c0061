// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

// A ball of negative radius is nothing, one of infinite radius is everything.

/// Returns the ball around all vertices of a mesh, its centre that of the mesh's box.
[[nodiscard]] Ball ball_around(const PreparedMesh& mesh);

/// Returns the smallest ball around two.
[[nodiscard]] Ball ball_around(const Ball& a, const Ball& b);

/// Returns a ball around another in a frame to which `T` transforms its own.
[[nodiscard]] Ball transformed(const Eigen::Isometry3d& T, const Ball& ball);

/// Returns, in the parent link's frame, a ball around all places of a ball in the child's frame:
/// with any angle of a joint that turns, and within the limits of a prismatic one. Infinite for a
/// planar, floating or unlimited prismatic joint.
[[nodiscard]] Ball swept(const Joint& joint, const Ball& ball);

/// Returns, of each link and in its frame, a ball around its geometry and that of its descendants.
[[nodiscard]] std::vector<Ball> reach_of_links(const Robot& robot);

/// Where links of unknown pose can be: a ball in the optical frame.
struct Reach {
  std::size_t link;  ///< the first of the links; it is not drawn
  Ball ball;
};

/// Draws the near side of each ball into a virtual depth image, as the link's number. A camera
/// inside a ball sees it at DepthRenderer::near_plane.
void draw_reaches(std::span<const Reach> reaches, const Intrinsics& intrinsics,
                  ImageView<float> depth, ImageView<std::uint16_t> links, TileMask& touched);

/// Returns the labels with `unknown` where a ball is the nearest, unless something real is measured
/// before it; elsewhere fringe stays. `known`: the labels without the balls; holds the result.
[[nodiscard]] LabelView unknown_in_reaches(const LabelView& labels,
                                           const ImageView<const std::uint16_t>& links,
                                           std::span<const Reach> reaches,
                                           Image<std::uint8_t>& known);

}  // namespace penumbra
