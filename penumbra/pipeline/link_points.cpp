// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/triangle_tree.hpp>
#include <penumbra/pipeline/link_points.hpp>
#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Triangle {
  Vector3d a, b, c;
  std::uint32_t place = 0;  ///< on a curve through space
  double area = 0.0;

  /// Returns a point; f and g from 0 to 1 are uniform by area.
  [[nodiscard]] Vector3d at(double f, double g) const {
    const double s = std::sqrt(f);
    return (1.0 - s) * a + s * (1.0 - g) * b + s * g * c;
  }
};

/// Returns the place of a point of the unit cube on Morton's curve: neighbours on it are neighbours
/// in space.
std::uint32_t morton_code(const Vector3d& unit) {
  constexpr unsigned bits = 10;  // of an axis
  std::uint32_t code = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto cell =
        static_cast<std::uint32_t>(std::clamp(unit[axis] * (1U << bits), 0.0, (1U << bits) - 1.0));
    for (unsigned bit = 0; bit < bits; ++bit) code |= (cell >> bit & 1U) << (3 * bit + axis);
  }
  return code;
}

/// Returns the triangles of a link that have an area, neighbours close to each other.
std::vector<Triangle> surface_of(const Robot& robot, std::size_t link) {
  const Eigen::AlignedBox3d& bounds = robot.report()[link].bounds;
  constexpr double least_size = 1e-9;  // metres: flat boxes have a size of 0
  const double size = std::max(bounds.diagonal().maxCoeff(), least_size);
  std::vector<Triangle> surface;
  for (const PreparedMesh& mesh : robot.meshes(link))
    for (const auto& [i, j, k] : mesh.triangles) {
      Triangle t{mesh.vertices[i].cast<double>(), mesh.vertices[j].cast<double>(),
                 mesh.vertices[k].cast<double>()};
      t.place = morton_code(((t.a + t.b + t.c) / 3.0 - bounds.min()) / size);
      t.area = 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
      if (t.area > 0.0) surface.push_back(t);
    }
  std::ranges::stable_sort(surface, {}, &Triangle::place);
  return surface;
}

/// Judges a point that no placed link hides, by its pixel.
void judge_by_pixel(const FrameReport& report, int u, int v, PointView& view) {
  const VirtualDepthView& drawn = report.virtual_depth;
  const std::size_t shown = drawn.links(u, v);
  if (static_cast<double>(drawn.depth(u, v)) < view.depth - PointJudge::same_surface) {
    if (shown > report.T_root_link.size()) {  // an attached body
      view.verdict = Verdict::hidden;
      view.hidden_by = static_cast<std::uint16_t>(shown);
      return;
    }
    const bool may_be_anywhere = shown != 0 && !report.T_root_link[shown - 1].matrix().allFinite();
    if (may_be_anywhere) return;
  }
  if (!report.missing_links.empty()) return;
  if (is_empty(report.depth)) {
    if (report.status == FrameStatus::ok) view.verdict = Verdict::visible;
    return;
  }
  const Label label = report.label(u, v);
  if (label == Label::occluded) view.verdict = Verdict::visible;
  if (label == Label::front) view.verdict = Verdict::hidden;
}

}  // namespace

std::vector<Vector3d> points_on(const Robot& robot, std::string_view link, std::size_t count) {
  const auto index = robot.find_link(link);
  if (!index)
    throw InputError("'" + std::string(link) + "' is not a link of robot '" + robot.name() +
                     "'; `penumbra inspect URDF` lists its links");
  const std::vector<Triangle> surface = surface_of(robot, *index);
  if (surface.empty())
    throw InputError("link '" + std::string(link) +
                     "' has no surface: " + robot.report()[*index].reason);
  double total = 0.0;
  for (const Triangle& triangle : surface) total += triangle.area;

  // One point of each of `count` equal parts of the area; across it by the golden ratio, so that
  // the points of a large triangle are a lattice.
  std::vector<Vector3d> points;
  points.reserve(count);
  double before = 0.0;  // area
  auto triangle = surface.begin();
  for (std::size_t i = 0; i < count; ++i) {
    const double area = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (area > before + triangle->area && triangle + 1 != surface.end())
      before += (triangle++)->area;
    double whole = 0.0;
    const double across = std::modf(static_cast<double>(i) * std::numbers::phi, &whole);
    points.push_back(triangle->at(std::min((area - before) / triangle->area, 1.0), across));
  }
  return points;
}

struct PointJudge::Trees {
  std::vector<std::vector<TriangleTree>> of_link;  // one for each mesh

  /// Returns the value in link images of the first link before a point of the optical frame; 0:
  /// there is none. `T_link_camera`: NaN for links of unknown pose.
  [[nodiscard]] std::uint16_t first_before(const Vector3d& point,
                                           std::span<const Eigen::Isometry3d> T_link_camera) const {
    std::uint16_t first = 0;
    double nearest = 1.0 - same_surface / point.norm();
    for (std::size_t link = 0; link < of_link.size(); ++link) {
      const Eigen::Isometry3d& T = T_link_camera[link];
      if (of_link[link].empty() || !T.matrix().allFinite()) continue;
      for (const TriangleTree& mesh : of_link[link]) {
        const double t = mesh.first_hit(T.translation(), T.linear() * point, nearest);
        if (t == TriangleTree::nowhere) continue;
        nearest = t;
        first = static_cast<std::uint16_t>(link + 1);
      }
    }
    return first;
  }
};

PointJudge::PointJudge(const Robot& robot) {
  auto trees = std::make_shared<Trees>();
  trees->of_link.resize(robot.links().size());
  for (std::size_t link = 0; link < trees->of_link.size(); ++link)
    for (const PreparedMesh& mesh : robot.meshes(link)) trees->of_link[link].emplace_back(mesh);
  trees_ = std::move(trees);
}

std::vector<PointView> PointJudge::judge(const FrameReport& report, const Camera& camera,
                                         std::string_view link,
                                         std::span<const Vector3d> points) const {
  const auto T_own_camera = camera_in_link(report, link);
  std::vector<PointView> views(points.size());
  if (!T_own_camera || !T_own_camera->matrix().allFinite()) return views;
  const VirtualDepthView& drawn = report.virtual_depth;
  if (drawn.depth.empty()) throw InputError("points are judged in images; a scan has none");
  const Eigen::Isometry3d T_camera_own = T_own_camera->inverse();
  std::vector<Eigen::Isometry3d> T_link_camera;
  for (const Eigen::Isometry3d& T_root_link : report.T_root_link)
    T_link_camera.push_back(T_root_link.inverse() * *report.T_root_camera);

  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InputError("point " + std::to_string(i) + " is not finite; expected metres");
    PointView& view = views[i];
    const Vector3d p = T_camera_own * points[i];
    view.depth = p.z();
    view.verdict = Verdict::out_of_view;
    const auto pixel = pixel_of(camera, p);
    if (!pixel) continue;
    view.pixel = *pixel;
    const double u = std::round(pixel->x()), v = std::round(pixel->y());
    if (!(u >= 0.0 && v >= 0.0 && u < drawn.depth.width && v < drawn.depth.height)) continue;
    view.hidden_by = trees_->first_before(p, T_link_camera);
    view.verdict = view.hidden_by != 0 ? Verdict::hidden : Verdict::unknown;
    if (view.hidden_by == 0) judge_by_pixel(report, static_cast<int>(u), static_cast<int>(v), view);
  }
  return views;
}

}  // namespace penumbra
