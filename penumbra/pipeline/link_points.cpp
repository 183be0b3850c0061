// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>
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

/// Depths are rounded (DepthRenderer::max_drawn_bodies), and slopes are differences of them.
constexpr double depth_rounding = 3e-4;

/// The robot's surface in an image. Between pixels it is the plane through the nearest ones: 1/z of
/// a plane is linear in the image. A link's point is on it if the plane of one of the pixels around
/// passes through the point, or less than a pixel's width behind it, since curved surfaces do.
class DrawnSurface {
 public:
  /// A raw image of a lens with distortion is resampled: its pixels are up to half a pixel off.
  DrawnSurface(const VirtualDepthView& drawn, const Camera& camera)
      : drawn_(drawn),
        pixel_width_(1.0 / std::min(camera.intrinsics.fx(), camera.intrinsics.fy())),
        reach_(camera.distortion.is_none() ? 0 : 1) {}

  struct Hit {
    double depth = 0.0;  ///< metres; 0: no robot
    std::uint16_t link = 0;
  };

  /// Returns what a pixel's surface, continued to a point of the image, has there.
  [[nodiscard]] Hit at(int u, int v, const Vector2d& point) const {
    const double w = inverse(u, v);
    if (w == 0.0) return {};
    const double along_u = slope(inverse(u - 1, v), w, inverse(u + 1, v));
    const double along_v = slope(inverse(u, v - 1), w, inverse(u, v + 1));
    const double there = w + along_u * (point.x() - u) + along_v * (point.y() - v);
    return {1.0 / std::max(there, 0.5 * w), drawn_.links(u, v)};
  }

  /// Returns what hides a link's point: a link image's value, 0 if nothing does; null where the
  /// robot is not drawn.
  [[nodiscard]] std::optional<std::uint16_t> hides(const Vector2d& point, double depth,
                                                   std::uint16_t own) const {
    const double nearest = depth * (1.0 - depth_rounding);
    const double farthest = depth * (1.0 + depth_rounding + pixel_width_);
    const Hit here = at(static_cast<int>(std::lround(point.x())),
                        static_cast<int>(std::lround(point.y())), point);
    if (here.link != 0 && here.link != own && here.depth < nearest) return here.link;
    const int u0 = static_cast<int>(std::floor(point.x())) - reach_;
    const int v0 = static_cast<int>(std::floor(point.y())) - reach_;
    const int size = 2 * (1 + reach_);
    Hit next = here;  // the nearest surface
    for (int v = v0; v < v0 + size; ++v)
      for (int u = u0; u < u0 + size; ++u) {
        const Hit hit = at(u, v, point);
        if (hit.link == own && nearest <= hit.depth && hit.depth <= farthest) return 0;
        if (hit.link != 0 && (next.link == 0 || hit.depth < next.depth)) next = hit;
      }
    if (next.link == 0) return std::nullopt;
    return next.depth >= nearest ? 0 : here.link != 0 ? here.link : next.link;
  }

 private:
  /// Returns 1/z, 0 where no robot is.
  [[nodiscard]] double inverse(int u, int v) const {
    if (u < 0 || v < 0 || u >= drawn_.depth.width || v >= drawn_.depth.height) return 0.0;
    const float z = drawn_.depth(u, v);
    return z > 0.0F ? 1.0 / static_cast<double>(z) : 0.0;
  }

  /// Returns the smaller difference to a neighbour: the other may be of another surface.
  static double slope(double before, double here, double after) {
    if (before == 0.0 && after == 0.0) return 0.0;
    if (before == 0.0) return after - here;
    if (after == 0.0) return here - before;
    return std::abs(here - before) < std::abs(after - here) ? here - before : after - here;
  }

  const VirtualDepthView& drawn_;
  double pixel_width_;  // at a depth of 1
  int reach_;           // pixels around a point's four
};

bool is_inside(const Vector2d& pixel, const ImageView<const float>& image) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < image.width - 0.5 &&
         pixel.y() < image.height - 0.5;
}

/// Returns the verdict on a point that the robot does not hide.
void judge_unhidden(const FrameReport& report, PointView& view) {
  if (!report.missing_links.empty()) return;
  if (is_empty(report.depth)) {
    if (report.status == FrameStatus::ok) view.verdict = Verdict::visible;
    return;
  }
  const Label label = report.label(static_cast<int>(std::lround(view.pixel.x())),
                                   static_cast<int>(std::lround(view.pixel.y())));
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
  constexpr double golden_ratio = 0.6180339887498949;
  std::vector<Vector3d> points;
  points.reserve(count);
  double before = 0.0;  // area
  auto triangle = surface.begin();
  for (std::size_t i = 0; i < count; ++i) {
    const double area = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (area > before + triangle->area && triangle + 1 != surface.end())
      before += (triangle++)->area;
    double whole = 0.0;
    const double across = std::modf(static_cast<double>(i) * golden_ratio, &whole);
    points.push_back(triangle->at(std::min((area - before) / triangle->area, 1.0), across));
  }
  return points;
}

std::vector<PointView> point_views(const FrameReport& report, const Camera& camera,
                                   std::string_view link, std::span<const Vector3d> points) {
  const auto T_link_camera = camera_in_link(report, link);
  std::vector<PointView> views(points.size());
  if (!T_link_camera || !T_link_camera->matrix().allFinite()) return views;
  const VirtualDepthView& drawn = report.virtual_depth;
  if (drawn.depth.empty()) throw InputError("points are judged in images; a scan has none");
  const Eigen::Isometry3d T_camera_link = T_link_camera->inverse();
  const auto value = static_cast<std::uint16_t>(  // in link images
      std::ranges::find(report.links, link) - report.links.begin() + 1);

  const DrawnSurface surface(drawn, camera);
  for (std::size_t i = 0; i < points.size(); ++i) {
    PointView& view = views[i];
    const Vector3d p = T_camera_link * points[i];
    view.depth = p.z();
    const auto pixel = pixel_of(camera, p);
    view.pixel = pixel.value_or(view.pixel);
    if (!pixel || !is_inside(*pixel, drawn.depth)) {
      view.verdict = Verdict::out_of_view;
      continue;
    }
    const auto hidden_by = surface.hides(*pixel, p.z(), value);
    if (!hidden_by) continue;
    if (*hidden_by == 0) {
      judge_unhidden(report, view);
    } else if (const std::size_t by = *hidden_by - 1U;
               by >= report.T_root_link.size() || report.T_root_link[by].matrix().allFinite()) {
      view.verdict = Verdict::hidden;
      view.hidden_by = *hidden_by;
    }
  }
  return views;
}

}  // namespace penumbra
