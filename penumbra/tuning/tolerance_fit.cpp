// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <penumbra/base/error.hpp>
#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/tuning/stages-inl.hpp>

namespace penumbra::tuning {
namespace {

constexpr double inside = 12.0;             // pixels from any edge of the robot
constexpr float edge = 0.02f;               // metres: a larger step of virtual depth is an edge
constexpr double bin_width = 0.1;           // metres of virtual depth
constexpr std::size_t least_in_bin = 1000;  // pixels, for a quantile of 1 in 1000
constexpr double outside_share = 0.001;     // fraction of residuals beyond e(z)
constexpr double object = 2.0;     // times the current e(z): larger residuals are another surface
constexpr double least_a = 0.005;  // metres
constexpr double round_to = 0.001;

struct Residual {
  float z, nearer;  // metres: virtual depth, and virtual minus measured depth
};

/// Returns edges of the robot and of objects in front of it.
NearestPixels edges_of(const Image<float>& depth, const LabelView& labels) {
  return {depth.width(), depth.height(), [&](int u, int v) {
            return !(depth(u, v) > 0.0f) ||
                   labels.labels(u, v) == static_cast<std::uint8_t>(Label::front) ||
                   (u > 0 && std::abs(depth(u, v) - depth(u - 1, v)) > edge) ||
                   (v > 0 && std::abs(depth(u, v) - depth(u, v - 1)) > edge);
          }};
}

std::vector<Residual> residuals_of(const Scene& scene, LabelRule rule) {
  for (double* const term : {&rule.tolerance.a, &rule.tolerance.b, &rule.tolerance.c})
    *term *= object;
  Classifier classifier(scene.camera.width(), scene.camera.height(), rule);
  std::vector<Residual> residuals;
  for (const KeptFrame& frame : scene.frames) {
    const NearestPixels edges = edges_of(frame.virtual_depth, label(classifier, frame));
    for (int v = 0; v < scene.camera.height(); ++v)
      for (int u = 0; u < scene.camera.width(); ++u) {
        const float z = frame.virtual_depth(u, v), d = frame.depth(u, v);
        if (z > 0.0f && d > 0.0f && edges.distance(u, v) >= inside &&
            std::abs(z - d) < rule.tolerance.at(z))
          residuals.push_back({z, z - d});
      }
  }
  return residuals;
}

/// Fits a + c z^2 to the bins' quantiles with equal weights.
Tolerance fit_curve(const std::vector<Residual>& residuals) {
  std::map<int, std::vector<float>> bins;
  for (const Residual& residual : residuals)
    bins[static_cast<int>(residual.z / bin_width)].push_back(residual.nearer);
  double n = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
  for (auto& [bin, values] : bins) {
    if (values.size() < std::min(least_in_bin, residuals.size() / bins.size())) continue;
    const double z = (bin + 0.5) * bin_width, squared = z * z;
    const double e = detail::quantile(values, 1.0 - outside_share);
    n += 1.0, x += squared, xx += squared * squared, y += e, xy += squared * e;
  }
  const double determinant = n * xx - x * x;
  Tolerance fit{.a = y / n, .b = 0.0, .c = 0.0};
  if (determinant > 1e-9) {
    fit.c = std::max(0.0, (n * xy - x * y) / determinant);
    fit.a = (y - fit.c * x) / n;
  }
  if (fit.a >= least_a) return fit;
  fit.a = least_a;
  fit.c = std::max(0.0, (xy - least_a * x) / xx);
  return fit;
}

/// Scales the curve so that it contains the required fraction of all residuals.
Tolerance scaled(const Tolerance& curve, const std::vector<Residual>& residuals) {
  std::vector<float> ratios;
  ratios.reserve(residuals.size());
  for (const Residual& residual : residuals)
    ratios.push_back(residual.nearer / static_cast<float>(curve.at(residual.z)));
  const double factor = detail::quantile(ratios, 1.0 - outside_share);
  const auto up = [](double value) {
    return std::max(0.0, std::ceil(value / round_to - 1e-6)) * round_to;
  };
  return {.a = up(std::max(least_a, factor * curve.a)), .b = 0.0, .c = up(factor * curve.c)};
}

double front_share(const Scene& scene, const LabelRule& rule) {
  Classifier classifier(scene.camera.width(), scene.camera.height(), rule);
  std::size_t front = 0, robot = 0;
  for (const KeptFrame& frame : scene.frames) {
    const LabelView labels = label(classifier, frame);
    for (const Label label : {Label::front, Label::occluded, Label::unknown, Label::beyond})
      robot += labels.pixels[static_cast<std::size_t>(label)];
    front += labels.pixels[static_cast<std::size_t>(Label::front)];
  }
  return static_cast<double>(front) / static_cast<double>(std::max<std::size_t>(robot, 1));
}

}  // namespace

ToleranceFit fit_tolerance(const Scene& scene, const LabelRule& current) {
  const std::vector<Residual> residuals = residuals_of(scene, current);
  if (residuals.size() < least_pixels)
    throw InputError("only " + std::to_string(residuals.size()) +
                     " pixels show the robot's surface at the URDF's depth; tune needs " +
                     std::to_string(least_pixels) + ": check joints, camera pose and depth first");
  ToleranceFit fit;
  fit.pixels = residuals.size();
  std::vector<float> nearer;
  nearer.reserve(residuals.size());
  for (const Residual& residual : residuals) nearer.push_back(residual.nearer);
  fit.bias = -detail::median(nearer);
  fit.tolerance = scaled(fit_curve(residuals), residuals);
  LabelRule then = current;
  then.tolerance = fit.tolerance;
  fit.false_front_now = front_share(scene, current);
  fit.false_front_then = front_share(scene, then);
  return fit;
}

}  // namespace penumbra::tuning
