// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <penumbra/base/error.hpp>
#include <penumbra/tuning/stages-inl.hpp>

namespace penumbra::tuning {
namespace {

constexpr double may_stay =
    0.0005;  // fraction of the arm's points left, beyond that of the largest reach
constexpr int candidates = FringeFit::farthest / FringeFit::step + 1;

struct Candidate {
  int u, v;
};

/// Pixels outside the outline that show the robot's depth, per frame and in total.
struct Fringe {
  std::vector<std::vector<Candidate>> pixels;
  std::array<std::size_t, FringeFit::farthest + 1> by_distance{};
  std::size_t found = 0, checked = 0;
  std::size_t robot = 0;  // pixels where the sensor sees it
};

void add_frame(const Scene& scene, const LabelView& labels, const TuningFrame& frame,
               const Tolerance& tolerance, const Image<std::uint8_t>& extra, Fringe& fringe) {
  const NearestPixels robot = seen_robot(labels);
  const NearestPixels parts(extra);
  std::vector<Candidate>& pixels = fringe.pixels.emplace_back();
  for (const Label label : {Label::front, Label::occluded, Label::beyond})
    fringe.robot += labels.pixels[static_cast<std::size_t>(label)];
  for (int v = 0; v < scene.camera.height(); ++v) {
    for (int u = 0; u < scene.camera.width(); ++u) {
      const float z = frame.depth(u, v);
      const double distance = robot.distance(u, v);
      if (frame.virtual_depth(u, v) > 0.0f || distance > FringeFit::farthest || !(z > 0.0f) ||
          !(scene.background(u, v) > 0.0f) || parts.distance(u, v) <= FringeFit::farthest)
        continue;
      ++fringe.checked;
      const auto [near_u, near_v] = robot.at(u, v);
      const float near = frame.depth(near_u, near_v);
      if (!scene.is_new(u, v, z, tolerance) ||
          std::abs(z - near) > LabelRule::fringe_drift * tolerance.at(near))
        continue;
      pixels.push_back({u, v});
      ++fringe.by_distance[static_cast<std::size_t>(std::ceil(distance))];
      ++fringe.found;
    }
  }
}

Fringe find_fringe(const Scene& scene, LabelRule rule, const ExtraSearch& extras) {
  rule.fringe_reach = 0;
  Labeller labeller(scene, rule);
  Fringe fringe;
  for (std::size_t i = 0; i < scene.frames.size(); ++i)
    add_frame(scene, labeller.label(scene.frames[i]), scene.frames[i], rule.tolerance,
              extras.pixels[i], fringe);
  return fringe;
}

double distance_of(const Fringe& fringe, double quantile) {
  const double wanted = quantile * static_cast<double>(fringe.found);
  std::size_t sum = 0;
  for (std::size_t i = 0; i < fringe.by_distance.size(); ++i)
    if (static_cast<double>(sum += fringe.by_distance[i]) >= wanted) return static_cast<double>(i);
  return FringeFit::farthest;
}

/// Returns the fraction of the arm's points that the rule leaves clear.
double left_over(const Scene& scene, const LabelRule& rule, const Fringe& fringe) {
  Labeller labeller(scene, rule);
  std::size_t left = 0;
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const LabelView labels = labeller.label(scene.frames[i]);
    for (const auto [u, v] : fringe.pixels[i])
      left += labels.labels(u, v) == static_cast<std::uint8_t>(Label::clear) ? 1 : 0;
  }
  return static_cast<double>(left) / static_cast<double>(fringe.robot + fringe.found);
}

void show(const Scene& scene, const LabelRule& rule, const Fringe& fringe, FringeFit& fit) {
  const auto most =
      std::max_element(fringe.pixels.begin(), fringe.pixels.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  fit.shown_frame = static_cast<std::size_t>(most - fringe.pixels.begin());
  fit.shown = Image<std::uint8_t>(scene.camera.width(), scene.camera.height());
  Labeller labeller(scene, rule);
  const LabelView labels = labeller.label(scene.frames[fit.shown_frame]);
  for (const auto [u, v] : *most)
    fit.shown(u, v) = labels.labels(u, v) == static_cast<std::uint8_t>(Label::clear)
                          ? FringeFit::left
                          : FringeFit::removed;
}

}  // namespace

FringeFit fit_fringe(const Scene& scene, const LabelRule& rule, const ExtraSearch& extras) {
  const Fringe fringe = find_fringe(scene, rule, extras);
  if (fringe.checked < least_pixels)
    throw InputError(
        "only " + std::to_string(fringe.checked) +
        " pixels next to the arm are visible without it in another frame; tune needs " +
        std::to_string(least_pixels) +
        ": record the arm while it moves farther through free space");
  FringeFit fit;
  fit.checked = fringe.checked;
  fit.found = fringe.found;
  fit.median = distance_of(fringe, 0.5);
  fit.percent_90 = distance_of(fringe, 0.9);
  fit.percent_99 = distance_of(fringe, 0.99);
  LabelRule tried = rule;
  for (int i = 0; i < candidates; ++i) {
    tried.fringe_reach = i * FringeFit::step;
    fit.left_over.push_back(left_over(scene, tried, fringe));
  }
  const double allowed = fit.left_over.back() + may_stay;
  const auto first = std::find_if(fit.left_over.begin(), fit.left_over.end(),
                                  [allowed](double fraction) { return fraction < allowed; });
  fit.reach = static_cast<int>(first - fit.left_over.begin()) * FringeFit::step;
  tried.fringe_reach = fit.reach;
  show(scene, tried, fringe, fit);
  return fit;
}

}  // namespace penumbra::tuning
