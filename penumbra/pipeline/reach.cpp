// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <penumbra/pipeline/reach-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Returns the depth at which the ray (x, y, 1) enters a ball; 0 if it does not.
double entry_depth(const Reach& reach, const Eigen::Vector3d& ray) {
  const double outside = reach.centre.squaredNorm() - reach.radius * reach.radius;
  if (outside <= 0.0) return DepthRenderer::near_plane;
  const double along = ray.dot(reach.centre);
  const double square = along * along - ray.squaredNorm() * outside;
  if (square < 0.0 || along <= 0.0) return 0.0;
  return std::max((along - std::sqrt(square)) / ray.squaredNorm(), DepthRenderer::near_plane);
}

}  // namespace

double travel_of(const Joint& joint) {
  if (joint.type == JointType::planar || joint.type == JointType::floating) return unlimited;
  if (joint.type != JointType::prismatic) return 0.0;
  if (!joint.lower || !joint.upper) return unlimited;
  return std::max(std::abs(*joint.lower), std::abs(*joint.upper));
}

std::vector<double> reach_of_links(const Robot& robot) {
  std::vector<double> reach(robot.links().size(), 0.0);
  for (std::size_t link = reach.size(); link-- > 0;) {  // children come after their parents
    for (const PreparedMesh& mesh : robot.meshes(link))
      for (const Eigen::Vector3f& vertex : mesh.vertices)
        reach[link] = std::max(reach[link], static_cast<double>(vertex.norm()));
    if (link == 0) break;
    const Joint& joint = robot.joints()[link - 1];
    reach[joint.parent] = std::max(
        reach[joint.parent], joint.origin.translation().norm() + travel_of(joint) + reach[link]);
  }
  return reach;
}

void draw_reaches(std::span<const Reach> reaches, const Intrinsics& intrinsics,
                  ImageView<float> depth, ImageView<std::uint16_t> links, TileMask& touched) {
  for (const Reach& reach : reaches)
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width; ++u) {
        const auto z = static_cast<float>(entry_depth(reach, intrinsics.ray(u, v)));
        float& nearest = depth(u, v);
        if (!(z > 0.0F) || (nearest > 0.0F && nearest <= z)) continue;
        nearest = z;
        links(u, v) = static_cast<std::uint16_t>(reach.link + 1);
        touched.mark(u, v, u, v);
      }
}

LabelView unknown_in_reaches(const LabelView& labels, const ImageView<const std::uint16_t>& links,
                             std::span<const Reach> reaches, Image<std::uint8_t>& copy) {
  copy.fit(labels.labels.width, labels.labels.height);
  LabelView result = labels;
  result.labels = copy.view();
  for (int v = 0; v < copy.height(); ++v)
    for (int u = 0; u < copy.width(); ++u) {
      const auto label = labels.labels(u, v);
      copy(u, v) = label;
      const bool is_seen = label == static_cast<std::uint8_t>(Label::occluded) ||
                           label == static_cast<std::uint8_t>(Label::beyond);
      const auto is_here = [&](const Reach& reach) { return reach.link + 1 == links(u, v); };
      if (!is_seen || std::none_of(reaches.begin(), reaches.end(), is_here)) continue;
      copy(u, v) = static_cast<std::uint8_t>(Label::unknown);
      --result.pixels[label];
      ++result.pixels[static_cast<std::size_t>(Label::unknown)];
    }
  return result;
}

}  // namespace penumbra
