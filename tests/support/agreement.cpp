// SPDX-License-Identifier: Apache-2.0
#include "agreement.hpp"

#include "pixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t errors_in_words = 8;

struct Pixel {
  int u, v;
  double z;  // as rendered
  std::uint16_t link;
};

/// The questions that a differing pixel raises, answered by rays near its centre.
class Inquiry {
 public:
  Inquiry(const RayOracle& oracle, const Intrinsics& intrinsics, const Pixel& pixel)
      : oracle_(oracle), intrinsics_(intrinsics), pixel_(pixel) {}

  /// Whether the surface shown is the nearest one, or coincides with it, for a ray at most `shift`
  /// pixels away; at the centre its plane then has the depth shown.
  [[nodiscard]] bool shown_surface_is_seen(double shift) const {
    return any_ray(shift, [&](const Vector3d& ray) { return shows(ray, shift); });
  }

  /// Whether a ray at most `shift` pixels away meets no robot at all.
  [[nodiscard]] bool background_is_seen(double shift) const {
    return any_ray(shift, [&](const Vector3d& ray) {
      return !oracle_.first_hit(ray, DepthRenderer::near_plane);
    });
  }

 private:
  template <typename Predicate>
  [[nodiscard]] bool any_ray(double shift, Predicate&& predicate) const {
    if (predicate(intrinsics_.ray(pixel_.u, pixel_.v))) return true;
    if (shift == 0.0) return false;
    for (const double part : {0.25, 0.5, 1.0})
      for (int i = 0; i < 16; ++i) {
        // On the square of half width `shift`: u and v each move by at most that much.
        const double angle = i * (M_PI / 8);
        Vector2d step(std::cos(angle), std::sin(angle));
        step *= shift * part / step.cwiseAbs().maxCoeff();
        if (predicate(intrinsics_.ray(pixel_.u + step.x(), pixel_.v + step.y()))) return true;
      }
    return false;
  }

  [[nodiscard]] bool shows(const Vector3d& ray, double shift) const {
    const auto first = oracle_.first_hit(ray, DepthRenderer::near_plane);
    if (!first) return false;
    const auto is_shown = [&](const RayHit& hit) {
      return hit.body + 1 == pixel_.link && plane_has_depth(hit, shift);
    };
    if (is_shown(*first)) return true;
    const double deepest = first->z + coincidence * std::max(1.0, first->z);
    const std::vector<RayHit> hits = oracle_.all_hits(ray, first->z, deepest);
    return std::any_of(hits.begin(), hits.end(), is_shown);
  }

  /// Whether the plane has the rendered depth at the pixel's centre or within `shift` of it.
  [[nodiscard]] bool plane_has_depth(const RayHit& hit, double shift) const {
    const double middle = hit.inverse_depth.dot(intrinsics_.ray(pixel_.u, pixel_.v));
    const double spread = shift * (std::abs(hit.inverse_depth.x()) / intrinsics_.fx() +
                                   std::abs(hit.inverse_depth.y()) / intrinsics_.fy());
    const double tolerance = interior_tolerance / pixel_.z;  // of 1/z, as of z, relative
    return std::abs(1.0 / pixel_.z - middle) <= spread + tolerance;
  }

  const RayOracle& oracle_;
  const Intrinsics& intrinsics_;
  Pixel pixel_;
};

void add_error(Agreement& agreement, const Pixel& pixel, double expected, unsigned expected_link,
               double seen_at) {
  ++agreement.errors;
  if (agreement.first_errors.size() >= errors_in_words) return;
  std::ostringstream words;
  words << "pixel (" << pixel.u << ", " << pixel.v << "): rendered " << pixel.z << " m of link "
        << pixel.link << ", expected " << expected << " m of link " << expected_link;
  if (seen_at <= silhouette_shift) words << "; seen within " << seen_at << " pixel";
  agreement.first_errors.push_back(words.str());
}

/// The smallest of some shifts that explains what the pixel shows; infinity if none does.
double shift_that_explains(const Inquiry& inquiry, const Pixel& pixel) {
  for (const double shift : {0.0, edge_shift, 0.02, 0.05, 0.1, 0.2, 0.5, silhouette_shift}) {
    const bool explained =
        pixel.link == 0 ? inquiry.background_is_seen(shift) : inquiry.shown_surface_is_seen(shift);
    if (explained) return shift;
  }
  return std::numeric_limits<double>::infinity();
}

void judge(Agreement& agreement, const Inquiry& inquiry, const Pixel& pixel, double expected,
           unsigned expected_link) {
  const double shift = shift_that_explains(inquiry, pixel);
  const bool coverage_differs = pixel.link == 0 || expected_link == 0;
  if (shift > (coverage_differs ? silhouette_shift : edge_shift)) {
    add_error(agreement, pixel, expected, expected_link, shift);
    return;
  }
  agreement.worst_shift = std::max(agreement.worst_shift, shift);
  if (coverage_differs) {
    ++agreement.silhouette_pixels;
  } else if (shift > 0.0) {
    ++agreement.edge_pixels;
  }
}

}  // namespace

double Agreement::differing_share() const {
  if (robot_pixels == 0)
    return silhouette_pixels + edge_pixels == 0 ? 0.0 : std::numeric_limits<double>::infinity();
  return double(silhouette_pixels + edge_pixels) / double(robot_pixels);
}

Agreement& Agreement::operator+=(const Agreement& other) {
  images += other.images;
  robot_pixels += other.robot_pixels;
  silhouette_pixels += other.silhouette_pixels;
  edge_pixels += other.edge_pixels;
  errors += other.errors;
  worst_interior = std::max(worst_interior, other.worst_interior);
  worst_shift = std::max(worst_shift, other.worst_shift);
  for (const std::string& words : other.first_errors)
    if (first_errors.size() < errors_in_words) first_errors.push_back(words);
  return *this;
}

std::ostream& operator<<(std::ostream& out, const Agreement& agreement) {
  out << agreement.images << " images, " << agreement.robot_pixels << " robot pixels, "
      << agreement.silhouette_pixels << " differ at silhouettes, " << agreement.edge_pixels
      << " at inner edges, together " << 100.0 * agreement.differing_share() << " %, all within "
      << agreement.worst_shift << " pixel; " << agreement.errors
      << " errors; worst interior depth error " << 1e3 * agreement.worst_interior << " mm at 1 m";
  for (const std::string& words : agreement.first_errors) out << "\n  " << words;
  return out;
}

Agreement compare(const VirtualDepthView& rendered, const RayOracle& oracle,
                  const OracleImage& expected, const Intrinsics& intrinsics) {
  Agreement agreement;
  agreement.images = 1;
  for (const auto [u, v] : each_pixel(intrinsics)) {
    const Pixel pixel{u, v, rendered.depth(u, v), rendered.links(u, v)};
    const double z = expected.depth(u, v);
    const unsigned link = expected.links(u, v);
    if (link != 0) ++agreement.robot_pixels;
    if (link == 0 && pixel.link == 0 && pixel.z == 0.0) continue;
    if ((pixel.link == 0) != (pixel.z == 0.0)) {
      // Depth and link image contradict each other.
      add_error(agreement, pixel, z, link, std::numeric_limits<double>::infinity());
      continue;
    }
    const double error = std::abs(pixel.z - z);
    const bool close = link != 0 && pixel.link != 0 && error <= interior_tolerance * z;
    if (close) agreement.worst_interior = std::max(agreement.worst_interior, error / z);
    if (close && pixel.link == link) continue;
    judge(agreement, Inquiry(oracle, intrinsics, pixel), pixel, z, link);
  }
  return agreement;
}

}  // namespace penumbra::test
