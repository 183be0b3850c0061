// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <variant>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/tuning/missing_parts.hpp>
#include <penumbra/tuning/nearest_pixel-inl.hpp>

namespace penumbra {
namespace {

constexpr double still = 1e-3;  // of a pose; links that do not move may touch their support
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);
constexpr auto clear_label = static_cast<std::uint8_t>(Label::clear);

}  // namespace

MissingParts::MissingParts(const Robot& robot, int fringe_reach)
    : robot_(robot), far_(far * fringe_reach), links_(robot.links().size()) {}

void MissingParts::add(const FrameReport& report) {
  if (report.pixels.fringe == 0 || !std::has_single_bit(++frames_)) return;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (frames_ == 1) links_[i].first_pose = report.T_root_link[i];
    if (!report.T_root_link[i].isApprox(links_[i].first_pose, still)) links_[i].has_moved = true;
  }
  measure(report);
}

/// Reads every fourth pixel of every fourth row to save time.
void MissingParts::measure(const FrameReport& report) {
  constexpr int step = 4;
  const auto label = [&](int u, int v) { return report.labels(step * u, step * v); };
  Image<std::uint8_t> seen((report.labels.width + step - 1) / step,
                           (report.labels.height + step - 1) / step);
  for (int v = 0; v < seen.height(); ++v)
    for (int u = 0; u < seen.width(); ++u) seen(u, v) = label(u, v) == occluded;
  const tuning::NearestPixels robot(seen);
  Measured& measured = measured_.emplace_back();
  measured.depth = Image<float>(seen.width(), seen.height());
  measured.T_root_camera = *report.T_root_camera;
  measured.T_root_link.assign(report.T_root_link.begin(), report.T_root_link.end());
  measured.fringe.resize(links_.size());
  std::visit(
      [&](const auto& depth) {
        for (int v = 0; v < seen.height(); ++v)
          for (int u = 0; u < seen.width(); ++u)
            if (label(u, v) == fringe || label(u, v) == clear_label)
              measured.depth(u, v) = metres_of(depth(step * u, step * v));
      },
      report.depth);
  for (int v = 0; v < seen.height(); ++v)
    for (int u = 0; u < seen.width(); ++u) {
      if (label(u, v) != fringe || std::isinf(robot.distance(u, v))) continue;
      const auto nearest = robot.at(u, v);
      const std::size_t of = report.virtual_depth.links(step * nearest.u, step * nearest.v);
      if (of > links_.size()) continue;  // an attached body
      measured.fringe[of - 1] += step * step;
      if (step * robot.distance(u, v) > far_)
        far_fringe_.push_back({measured_.size() - 1, of - 1, u, v});
    }
}

bool MissingParts::stands_still(const Far& pixel) const {
  constexpr float same = 0.03F;   // metres
  constexpr double moved = 0.05;  // metres, as of pose_difference
  const Measured& at = measured_[pixel.frame];
  return std::ranges::any_of(measured_, [&](const Measured& other) {
    return other.T_root_camera.isApprox(at.T_root_camera, still) &&
           pose_difference(other.T_root_link[pixel.link], at.T_root_link[pixel.link]) > moved &&
           std::abs(other.depth(pixel.u, pixel.v) - at.depth(pixel.u, pixel.v)) < same;
  });
}

std::vector<std::string> MissingParts::lines() const {
  constexpr std::size_t pixels = 16;  // for each that is measured
  std::vector<std::vector<std::size_t>> moving(measured_.size(),
                                               std::vector<std::size_t>(links_.size()));
  for (const Far& pixel : far_fringe_)
    if (!stands_still(pixel)) moving[pixel.frame][pixel.link] += pixels;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    std::size_t judged = 0, with_part = 0;  // frames
    for (std::size_t frame = 0; frame < measured_.size(); ++frame) {
      const std::size_t pixels_next = measured_[frame].fringe[i];
      if (pixels_next < least_fringe) continue;
      ++judged;
      if (static_cast<double>(moving[frame][i]) > most * static_cast<double>(pixels_next))
        ++with_part;
    }
    if (links_[i].has_moved && with_part >= 2 && 2 * with_part >= judged)
      lines.push_back("something large moves with link '" + robot_.links()[i] +
                      "' that the URDF lacks, or touches it: run 'penumbra tune' on this input");
  }
  return lines;
}

}  // namespace penumbra
