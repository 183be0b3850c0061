// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>
#include <utility>

#include <Eigen/LU>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>

namespace penumbra {
namespace {

using Point = Eigen::Vector2f;  // on the plane z = 1

/// The rays that a pinhole image must contain.
struct RayBounds {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  double stretch = 0;  // the largest scale relative to the raw focal length

  void add(const RayBounds& other) {
    low = low.min(other.low);
    high = high.max(other.high);
    stretch = std::max(stretch, other.stretch);
  }
  [[nodiscard]] bool empty() const { return !(stretch > 0); }
};

double largest_singular_value(const Eigen::Matrix2d& m) {
  const double sum = m.squaredNorm();
  const double det = m.determinant();
  return std::sqrt(0.5 * (sum + std::sqrt(std::max(sum * sum - 4 * det * det, 0.0))));
}

/// Returns the pinhole image of that extent, with focal lengths so that no pixel is larger than a
/// raw one, and with the principal point whole pixels from the raw one; nothing if it is too large.
std::optional<Intrinsics> pinhole_of(const RayBounds& extent, const Intrinsics& raw,
                                     double fineness) {
  if (!(extent.stretch <= Rectification::max_stretch)) return std::nullopt;
  const Eigen::Array2d focal = fineness * extent.stretch * Eigen::Array2d(raw.fx(), raw.fy());
  const Eigen::Array2d centre(raw.cx(), raw.cy());
  const Eigen::Array2d shift = (0.5 - (extent.low * focal + centre)).floor();
  const Eigen::Array2d size = (extent.high * focal + centre + shift + 0.5).floor() + 1;
  const double raw_pixels = static_cast<double>(raw.width()) * raw.height();
  const double wanted = std::max(static_cast<double>(Rectification::max_pixels), 4 * raw_pixels);
  const double most = std::min(wanted, static_cast<double>(Intrinsics::max_pixels));
  if (!(size.maxCoeff() <= Intrinsics::max_size && size.prod() <= most)) return std::nullopt;
  if (!(focal.maxCoeff() <= Intrinsics::max_focal)) return std::nullopt;
  return Intrinsics(static_cast<int>(size.x()), static_cast<int>(size.y()), focal.x(), focal.y(),
                    centre.x() + shift.x(), centre.y() + shift.y());
}

/// Bounds of rays by their angle from the optical axis, to choose the widest cone that fits.
class BoundsByAngle {
 public:
  BoundsByAngle(double max_angle, double fineness) : max_angle_(max_angle), fineness_(fineness) {}

  void add(const Eigen::Vector2d& ray, double stretch) {
    const double fraction = std::atan(ray.norm()) / max_angle_;
    const auto bin = std::min(static_cast<std::size_t>(fraction * bins_.size()), bins_.size() - 1);
    bins_[bin].add({ray.array(), ray.array(), stretch});
  }

  /// Returns the pinhole image of the widest cone that fits and its half angle, or throws
  /// LensError.
  [[nodiscard]] std::pair<Intrinsics, double> widest(const Intrinsics& raw) const {
    std::optional<Intrinsics> best;
    double angle = 0;
    RayBounds extent;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      extent.add(bins_[i]);
      if (extent.empty()) continue;
      const auto wider = pinhole_of(extent, raw, fineness_);
      if (!wider) break;
      best = wider;
      angle = max_angle_ * static_cast<double>(i + 1) / static_cast<double>(bins_.size());
    }
    if (!best) {
      std::ostringstream what;
      what << "camera: the lens distortion reaches no pixel of the " << raw.width() << " x "
           << raw.height() << " image within " << max_angle_ * 180 / std::numbers::pi
           << " degrees of the optical axis; check the distortion coefficients and intrinsics";
      throw LensError(what.str());
    }
    return {*best, angle};
  }

 private:
  double max_angle_, fineness_;
  std::array<RayBounds, 256> bins_;
};

/// Returns the index of the pixel nearest to `image_point`, or no_pixel outside of the image.
std::int32_t nearest(const Eigen::Vector2d& image_point, const Intrinsics& image) {
  const double u = std::floor(image_point.x() + 0.5);
  const double v = std::floor(image_point.y() + 0.5);
  if (!(u >= 0 && v >= 0 && u < image.width() && v < image.height()))
    return Rectification::no_pixel;
  return static_cast<std::int32_t>(v) * image.width() + static_cast<std::int32_t>(u);
}

Eigen::Vector2d project(const Eigen::Vector2d& ray, const Intrinsics& image) {
  return image.project({ray.x(), ray.y(), 1});
}

}  // namespace

struct Rectification::Plan {
  Intrinsics pinhole;
  double half_angle;
  Image<Point> rays;  // of raw pixels; NaN if not covered
};

Rectification::Rectification(const Camera& raw, double max_half_angle, double fineness)
    : Rectification(raw, plan(raw, max_half_angle, fineness)) {}

Rectification::Rectification(const Camera& raw, const Plan& plan)
    : pinhole_(plan.pinhole),
      half_angle_(plan.half_angle),
      to_pinhole_(raw.intrinsics.width(), raw.intrinsics.height(), no_pixel),
      to_raw_(pinhole_.width(), pinhole_.height(), no_pixel) {
  const Eigen::Vector2d low(0, 0);
  const Eigen::Vector2d high(pinhole_.width() - 1, pinhole_.height() - 1);
  for (std::size_t i = 0; i < to_pinhole_.size(); ++i) {
    const Eigen::Vector2d ray = plan.rays.data()[i].cast<double>();
    if (ray.hasNaN()) continue;
    // The outermost rays are up to half a pixel outside of the outermost pixel centres.
    const Eigen::Vector2d inside = project(ray, pinhole_).cwiseMax(low).cwiseMin(high);
    to_pinhole_.data()[i] = nearest(inside, pinhole_);
  }
  map_pinhole(raw);
  list_tiles();
}

Rectification::Plan Rectification::plan(const Camera& raw, double max_half_angle, double fineness) {
  assert(max_half_angle > 0 && max_half_angle < std::numbers::pi / 2);
  const Intrinsics& k = raw.intrinsics;
  const Point nowhere = Point::Constant(std::numeric_limits<float>::quiet_NaN());
  Image<Point> rays(k.width(), k.height(), nowhere);
  BoundsByAngle extents(max_half_angle, fineness);
  const double reach = std::tan(max_half_angle);
  for (int v = 0; v < k.height(); ++v) {
    for (int u = 0; u < k.width(); ++u) {
      const auto ray = raw.distortion.undistort(k.ray(u, v).head<2>());
      if (!ray || !(ray->norm() <= reach)) continue;
      Eigen::Matrix2d step = raw.distortion.derivative(*ray);
      step(0, 1) *= k.fx() / k.fy();
      step(1, 0) *= k.fy() / k.fx();
      extents.add(*ray, largest_singular_value(step));
      rays(u, v) = ray->cast<float>();
    }
  }
  const auto [pinhole, half_angle] = extents.widest(k);
  if (half_angle < max_half_angle) {
    const double covered = std::tan(half_angle);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!(rays.data()[i].norm() <= covered)) rays.data()[i] = nowhere;
  }
  return {pinhole, half_angle, std::move(rays)};
}

void Rectification::map_pinhole(const Camera& raw) {
  const double reach = std::min(std::tan(half_angle_), raw.distortion.max_radius());
  for (int v = 0; v < pinhole_.height(); ++v) {
    for (int u = 0; u < pinhole_.width(); ++u) {
      const Eigen::Vector2d ray = pinhole_.ray(u, v).head<2>();
      if (ray.norm() <= reach)
        to_raw_(u, v) =
            nearest(project(raw.distortion.distort(ray), raw.intrinsics), raw.intrinsics);
    }
  }
}

/// Lists the raw tiles that get pixels from each pinhole tile.
void Rectification::list_tiles() {
  const TileMask pinhole(pinhole_.width(), pinhole_.height());
  const TileMask raw(to_pinhole_.width(), to_pinhole_.height());
  std::vector<std::vector<RawTiles>> targets(pinhole.rows.size() * 64);
  for (int v = 0; v < raw.height; ++v) {
    const auto row = static_cast<std::uint32_t>(v / TileMask::tile_height);
    for (int u = 0; u < raw.width; ++u) {
      const std::int32_t i = to_pinhole_(u, v);
      if (i == no_pixel) continue;
      const int tile =
          i / pinhole.width / TileMask::tile_height * 64 + i % pinhole.width / pinhole.tile_width;
      auto& list = targets[static_cast<std::size_t>(tile)];
      if (list.empty() || list.back().row != row) list.push_back({row, 0});
      list.back().columns |= std::uint64_t{1} << (u / raw.tile_width);
    }
  }
  for (const auto& list : targets) {
    first_.push_back(static_cast<std::uint32_t>(tiles_.size()));
    tiles_.insert(tiles_.end(), list.begin(), list.end());
  }
  first_.push_back(static_cast<std::uint32_t>(tiles_.size()));
}

void Rectification::touched_raw(const TileMask& pinhole, TileMask& raw) const {
  assert(pinhole.width == pinhole_.width() && pinhole.height == pinhole_.height());
  assert(raw.width == to_pinhole_.width() && raw.height == to_pinhole_.height());
  std::fill(raw.rows.begin(), raw.rows.end(), std::uint64_t{0});
  for (std::size_t j = 0; j < pinhole.rows.size(); ++j) {
    for (std::uint64_t bits = pinhole.rows[j]; bits != 0; bits &= bits - 1) {
      const std::size_t tile = j * 64 + static_cast<std::size_t>(std::countr_zero(bits));
      for (std::uint32_t i = first_[tile]; i < first_[tile + 1]; ++i)
        raw.rows[tiles_[i].row] |= tiles_[i].columns;
    }
  }
}

}  // namespace penumbra
