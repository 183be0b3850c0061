// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <penumbra/poses/reach.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Returns the depth at which the ray (x, y, 1) enters a ball; 0 if it does not.
double entry_depth(const Ball& ball, const Eigen::Vector3d& ray) {
  const double outside = ball.centre.squaredNorm() - ball.radius * ball.radius;
  if (outside <= 0.0) return DepthRenderer::near_plane;
  const double along = ray.dot(ball.centre);
  const double square = along * along - ray.squaredNorm() * outside;
  if (square < 0.0 || along <= 0.0) return 0.0;
  return std::max((along - std::sqrt(square)) / ray.squaredNorm(), DepthRenderer::near_plane);
}

/// The pixels [u0, u1) x [v0, v1).
struct Pixels {
  int u0, u1, v0, v1;
};

/// Returns the pixels whose rays may meet a ball: those of the box around it.
Pixels pixels_of(const Ball& ball, const Intrinsics& camera) {
  const double near = ball.centre.z() - ball.radius, far = ball.centre.z() + ball.radius;
  if (!(near > DepthRenderer::near_plane)) return {0, camera.width(), 0, camera.height()};
  const auto range = [&](int axis, double focal, double middle, int size) {
    const double a = ball.centre[axis] - ball.radius, b = ball.centre[axis] + ball.radius;
    const double first = middle + focal * std::min(a / near, a / far);
    const double last = middle + focal * std::max(b / near, b / far);
    return std::pair(static_cast<int>(std::clamp<double>(std::floor(first), 0, size)),
                     static_cast<int>(std::clamp<double>(std::ceil(last) + 1, 0, size)));
  };
  const auto [u0, u1] = range(0, camera.fx(), camera.cx(), camera.width());
  const auto [v0, v1] = range(1, camera.fy(), camera.cy(), camera.height());
  return {u0, u1, v0, v1};
}

}  // namespace

Ball ball_around(const PreparedMesh& mesh) {
  Ball ball{mesh.bounds.center(), 0.0};
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    ball.radius = std::max(ball.radius, (vertex.cast<double>() - ball.centre).norm());
  return ball;
}

Ball ball_around(const Ball& a, const Ball& b) {
  if (b.radius < 0.0) return a;
  const double apart = (b.centre - a.centre).norm();
  if (a.radius < 0.0 || apart + a.radius <= b.radius) return b;
  if (apart + b.radius <= a.radius) return a;
  const double radius = 0.5 * (apart + a.radius + b.radius);
  return {a.centre + (radius - a.radius) / apart * (b.centre - a.centre), radius};
}

Ball transformed(const Eigen::Isometry3d& T, const Ball& ball) {
  return {T * ball.centre, ball.radius};
}

Ball swept(const Joint& joint, const Ball& ball) {
  if (ball.radius < 0.0) return ball;
  Ball all = ball;
  switch (joint.type) {
    case JointType::fixed:
      break;
    case JointType::revolute:
    case JointType::continuous:
      all.centre = joint.axis.dot(ball.centre) * joint.axis;
      all.radius += (ball.centre - all.centre).norm();
      break;
    case JointType::prismatic:
      if (!joint.lower || !joint.upper) return {{0.0, 0.0, 0.0}, unlimited};
      all.centre += 0.5 * (*joint.lower + *joint.upper) * joint.axis;
      all.radius += 0.5 * (*joint.upper - *joint.lower);
      break;
    case JointType::planar:
    case JointType::floating:
      return {{0.0, 0.0, 0.0}, unlimited};
  }
  return transformed(joint.origin, all);
}

std::vector<Ball> reach_of_links(const Robot& robot) {
  std::vector<Ball> reach(robot.links().size(), {{0.0, 0.0, 0.0}, -1.0});
  for (std::size_t link = reach.size(); link-- > 0;) {  // children come after their parents
    for (const PreparedMesh& mesh : robot.meshes(link))
      reach[link] = ball_around(reach[link], ball_around(mesh));
    if (link == 0) break;
    const Joint& joint = robot.joints()[link - 1];
    reach[joint.parent] = ball_around(reach[joint.parent], swept(joint, reach[link]));
  }
  return reach;
}

void draw_reaches(std::span<const Reach> reaches, const Intrinsics& intrinsics,
                  ImageView<float> depth, ImageView<std::uint16_t> links, TileMask& touched) {
  for (const Reach& reach : reaches) {
    const Pixels pixels = pixels_of(reach.ball, intrinsics);
    for (int v = pixels.v0; v < pixels.v1; ++v)
      for (int u = pixels.u0; u < pixels.u1; ++u) {
        const auto z = static_cast<float>(entry_depth(reach.ball, intrinsics.ray(u, v)));
        float& nearest = depth(u, v);
        if (!(z > 0.0F) || (nearest > 0.0F && nearest <= z)) continue;
        nearest = z;
        links(u, v) = static_cast<std::uint16_t>(reach.link + 1);
        touched.mark(u, v, u, v);
      }
  }
}

LabelView unknown_in_reaches(const LabelView& labels, const ImageView<const std::uint16_t>& links,
                             std::span<const Reach> reaches, Image<std::uint8_t>& known) {
  LabelView result = labels;
  result.labels = known.view();
  result.touched = nullptr;  // there may be fringe elsewhere
  for (int v = 0; v < known.height(); ++v)
    for (int u = 0; u < known.width(); ++u) {
      const auto before = static_cast<Label>(known(u, v));
      const auto label = static_cast<Label>(labels.labels(u, v));
      const auto is_here = [&](const Reach& reach) { return reach.link + 1 == links(u, v); };
      Label now = before == Label::fringe && is_trusted(label) ? before : label;
      if (std::any_of(reaches.begin(), reaches.end(), is_here))
        now = is_trusted(before) && label == Label::front ? label : Label::unknown;
      known(u, v) = static_cast<std::uint8_t>(now);
      --result.pixels[static_cast<std::size_t>(label)];
      ++result.pixels[static_cast<std::size_t>(now)];
    }
  return result;
}

}  // namespace penumbra
