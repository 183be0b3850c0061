// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <research/detectors.hpp>

namespace penumbra::research {
namespace {

// The noise of the detectors.
constexpr double shift_sigma = 2.0;     // pixels: of the whole mask's place
constexpr double corner_sigma = 1.5;    // pixels: of each corner (amodal)
constexpr double eroded_border = 0.15;  // fraction of the border that is eroded, in patches (modal)
constexpr double least_area = 40;       // pixels: smaller masks are not found (modal)

/// Returns the convex hull of points, in one sense (Andrew's monotone chain).
std::vector<Eigen::Vector2d> hull_of(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto turns_left = [](const auto& o, const auto& a, const auto& b) {
    return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x() > 0;
  };
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point))
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void fill_hull(const std::vector<Eigen::Vector2d>& hull, Image<std::uint8_t>& mask) {
  for (int v = 0; v < mask.height(); ++v) {
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
      if ((a.y() <= v) == (b.y() <= v)) continue;
      const double u = a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      from = std::min(from, u);
      to = std::max(to, u);
    }
    const double last = std::min(std::floor(to), mask.width() - 1.0);
    for (double u = std::max(std::ceil(from), 0.0); u <= last; ++u)
      mask(static_cast<int>(u), v) = 255;
  }
}

/// Returns the box around a mask; nothing if it has fewer pixels than `least`.
std::optional<PixelBox> box_around(const Image<std::uint8_t>& mask, double least) {
  int u0 = mask.width(), v0 = mask.height(), u1 = -1, v1 = -1, count = 0;
  for (int v = 0; v < mask.height(); ++v)
    for (int u = 0; u < mask.width(); ++u)
      if (mask(u, v) != 0) {
        u0 = std::min(u0, u), u1 = std::max(u1, u);
        v0 = std::min(v0, v), v1 = std::max(v1, v);
        ++count;
      }
  if (count == 0 || count < least) return std::nullopt;
  return PixelBox{static_cast<double>(u0), static_cast<double>(v0), u1 - u0 + 1.0, v1 - v0 + 1.0};
}

/// Erodes squares at some of the mask's border pixels.
void erode_border(Image<std::uint8_t>& mask, double fraction, std::mt19937_64& random) {
  constexpr int radius = 2;  // pixels
  const Image<std::uint8_t> whole = mask;
  std::bernoulli_distribution eroded(fraction / (2 * radius));
  for (int v = 1; v + 1 < whole.height(); ++v)
    for (int u = 1; u + 1 < whole.width(); ++u) {
      if (whole(u, v) == 0) continue;
      const bool border = whole(u - 1, v) == 0 || whole(u + 1, v) == 0 || whole(u, v - 1) == 0 ||
                          whole(u, v + 1) == 0;
      if (!border || !eroded(random)) continue;
      for (int y = std::max(v - radius, 0); y <= std::min(v + radius, mask.height() - 1); ++y)
        for (int x = std::max(u - radius, 0); x <= std::min(u + radius, mask.width() - 1); ++x)
          mask(x, y) = 0;
    }
}

}  // namespace

std::array<Eigen::Vector2d, 8> project_box(const Camera& camera,
                                           const Eigen::Isometry3d& T_camera_object,
                                           const Eigen::Vector3d& size) {
  std::array<Eigen::Vector2d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                                (i & 4) != 0 ? 0.5 : -0.5);
    corners[static_cast<std::size_t>(i)] =
        camera.intrinsics.project(T_camera_object * signs.cwiseProduct(size));
  }
  return corners;
}

const sim::ObjectTruth& object_named(const sim::SimFrame& frame, std::string_view name) {
  for (const sim::ObjectTruth& object : frame.objects)
    if (object.name == name) return object;
  throw std::logic_error("the scene has no object '" + std::string(name) + "'");
}

std::optional<Detection> AmodalDetector::detect(const sim::SimFrame& frame) {
  const sim::ObjectTruth& object = object_named(frame, "parcel");
  const Eigen::Isometry3d pose = cell_.T_base_camera.inverse() * object.T_base_object;
  std::normal_distribution<double> unit;
  const auto noise = [&](double sigma) {
    const double x = sigma * unit(random_);
    return Eigen::Vector2d(x, sigma * unit(random_));
  };
  const Eigen::Vector2d shift = noise(shift_sigma);
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector2d& corner : project_box(cell_.camera, pose, cell_.object_size))
    corners.push_back(corner + shift + noise(corner_sigma));
  Detection found;
  found.mask = Image<std::uint8_t>(frame.color.width(), frame.color.height());
  fill_hull(hull_of(corners), found.mask);
  const auto box = box_around(found.mask, 1);
  if (!box) return std::nullopt;
  found.box = *box;
  return found;
}

std::optional<Detection> ModalDetector::detect(const sim::SimFrame& frame) {
  const sim::ObjectTruth& object = object_named(frame, "parcel");
  std::normal_distribution<double> shift(0.0, shift_sigma);
  const int du = static_cast<int>(std::lround(shift(random_)));
  const int dv = static_cast<int>(std::lround(shift(random_)));
  Detection found;
  found.extent = Extent::modal;
  found.mask = Image<std::uint8_t>(frame.ids.width(), frame.ids.height());
  for (int v = 0; v < frame.ids.height(); ++v)
    for (int u = 0; u < frame.ids.width(); ++u) {
      const int x = u + du, y = v + dv;
      if (frame.ids(u, v) == object.id && x >= 0 && y >= 0 && x < found.mask.width() &&
          y < found.mask.height())
        found.mask(x, y) = 255;
    }
  erode_border(found.mask, eroded_border, random_);
  const auto box = box_around(found.mask, least_area);
  if (!box) return std::nullopt;
  found.box = *box;
  return found;
}

std::optional<Eigen::Vector2d> KeypointDetector::detect(const sim::SimFrame& frame) {
  const Eigen::Vector3d wrist =
      cell_.T_base_camera.inverse() * object_named(frame, "wrist").T_base_object.translation();
  const double du = noise_(random_), dv = noise_(random_);
  if (wrist.z() <= 0) return std::nullopt;
  const Eigen::Vector2d pixel = cell_.camera.intrinsics.project(wrist) + Eigen::Vector2d(du, dv);
  if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > frame.color.width() - 1 ||
      pixel.y() > frame.color.height() - 1)
    return std::nullopt;
  return pixel;
}

}  // namespace penumbra::research
