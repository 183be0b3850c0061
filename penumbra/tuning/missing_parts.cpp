// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/tuning/missing_parts.hpp>
#include <penumbra/tuning/stages-inl.hpp>

namespace penumbra {
namespace {

// A link is named if in half of the frames, two or more, over `most_far` of the fringe pixels next
// to it are farther from the outline than `far_share` times the fringe's reach. On a real recording
// complete links exceed `most_far` in at most one frame; where a part of 10 cm is missing, in half.
constexpr double far_share = 0.6;
constexpr double most_far = 0.15;
constexpr double least_fringe = 100.0;  // pixels; less is too little to judge a link by
constexpr double still_camera = 1e-3;   // of a pose
constexpr int read_step = 2;            // pixels of which one is read

/// The fringe pixels next to a link in a frame.
struct Fringe {
  double all = 0.0, moving = 0.0;  // moving: far from the outline, and not what stands still
};

bool is(const KeptFrame& frame, Label label, int u, int v) {
  return frame.labels(u, v) == static_cast<std::uint8_t>(label);
}

/// Whether another frame shows the same there although the link was elsewhere.
bool stands_still(std::span<const KeptFrame> frames, const KeptFrame& at, std::size_t link, int u,
                  int v) {
  constexpr float same = 0.03F;   // metres
  constexpr double moved = 0.05;  // metres, as of pose_difference
  return std::ranges::any_of(frames, [&](const KeptFrame& other) {
    return other.T_root_camera->isApprox(*at.T_root_camera, still_camera) &&
           pose_difference(other.T_root_link[link], at.T_root_link[link]) > moved &&
           (is(other, Label::clear, u, v) || is(other, Label::fringe, u, v)) &&
           std::abs(other.depth(u, v) - at.depth(u, v)) < same;
  });
}

std::vector<Fringe> fringe_by_link(std::span<const KeptFrame> frames, const KeptFrame& frame,
                                   std::size_t links, double reach) {
  const int width = (frame.labels.width() + read_step - 1) / read_step;
  const int height = (frame.labels.height() + read_step - 1) / read_step;
  const tuning::NearestPixels robot(width, height, [&](int u, int v) {
    return is(frame, Label::occluded, read_step * u, read_step * v);
  });
  std::vector<Fringe> fringe(links);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (!is(frame, Label::fringe, read_step * u, read_step * v) ||
          std::isinf(robot.distance(u, v)))
        continue;
      const auto nearest = robot.at(u, v);
      const std::size_t link =
          frame.links(read_step * nearest.u, read_step * nearest.v) - std::size_t{1};
      if (link >= links) continue;  // an attached body
      fringe[link].all += read_step * read_step;
      if (read_step * robot.distance(u, v) > far_share * reach &&
          !stands_still(frames, frame, link, read_step * u, read_step * v))
        fringe[link].moving += read_step * read_step;
    }
  return fringe;
}

}  // namespace

std::vector<bool> tuning::moving_links(std::span<const KeptFrame> frames) {
  constexpr double still = 1e-3;
  std::vector<bool> moves;
  const std::vector<Eigen::Isometry3d>& first = frames.front().T_root_link;
  for (std::size_t link = 0; link < first.size(); ++link)
    moves.push_back(std::ranges::any_of(frames, [&](const KeptFrame& frame) {
      return !frame.T_root_link[link].isApprox(first[link], still);
    }));
  return moves;
}

std::vector<std::string> missing_parts(std::span<const KeptFrame> frames, const Robot& robot,
                                       double fringe_reach) {
  if (frames.empty()) return {};
  const std::size_t links = robot.links().size();
  std::vector<std::size_t> judged(links), with_part(links);  // frames
  for (const KeptFrame& frame : frames) {
    const std::vector<Fringe> fringe = fringe_by_link(frames, frame, links, fringe_reach);
    for (std::size_t link = 0; link < links; ++link) {
      if (fringe[link].all < least_fringe) continue;
      ++judged[link];
      with_part[link] += fringe[link].moving > most_far * fringe[link].all;
    }
  }
  const std::vector<bool> moves = tuning::moving_links(frames);
  std::vector<std::string> lines;
  for (std::size_t link = 0; link < links; ++link)
    if (moves[link] && with_part[link] >= 2 && 2 * with_part[link] >= judged[link])
      lines.push_back("something large moves with link '" + robot.links()[link] +
                      "' that the URDF lacks, or touches it: run 'penumbra tune' on this input");
  return lines;
}

}  // namespace penumbra
