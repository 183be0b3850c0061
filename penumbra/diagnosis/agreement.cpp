// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/diagnosis/hypothesis-inl.hpp>

namespace penumbra::diagnosis {
namespace {

constexpr double least_agreeing = 0.002;  // of the image; a speck, or nothing, explains nothing
constexpr double least_of_scan = 0.0005;  // the same where most of the image is not measured

}  // namespace

Agreement::Agreement(const Setup& setup, std::span<const KeptFrame* const> frames)
    : setup_(setup), small_(setup.robot, setup.camera, frames) {
  if (!setup.has_colors()) return;
  small_.compare_colors();
  colors_.emplace(small_);
}

/// Of a frame for which the hypothesis has no poses, the given ones.
Poses Agreement::T_camera_link(const Hypothesis& hypothesis, std::size_t frame) const {
  const Poses& of_hypothesis = hypothesis.T_root_link[frame];
  const Poses& T_root_link =
      of_hypothesis.empty() ? setup_.frames[frame].T_root_link : of_hypothesis;
  const Eigen::Isometry3d T_camera_root =
      (T_root_link[setup_.parent] * hypothesis.T_parent_camera).inverse();
  Poses poses;
  poses.reserve(T_root_link.size());
  for (const Eigen::Isometry3d& pose : T_root_link) poses.push_back(T_camera_root * pose);
  return poses;
}

Agreement::Counts Agreement::count(const Hypothesis& hypothesis, std::size_t frame,
                                   float tolerance) {
  const VirtualDepthView view = small_.render(T_camera_link(hypothesis, frame));
  const auto factor = static_cast<float>(hypothesis.depth_factor);
  const SmallFrames::Small& small = small_.frames()[frame];
  Counts counts;
  const auto add = [&](int u, int v) {
    const float expected = view.depth(u, v);
    float z = factor * small.depth(u, v);
    if (hypothesis.along_ray) z /= static_cast<float>(small_.camera().ray(u, v).norm());
    if (!(expected > 0.0f)) {
      if (small.moved(u, v) == 0) return;
      counts.most += 1.0;
      counts.score -= SmallFrames::missed;
      return;
    }
    counts.most += 1.0;
    if (!(z > 0.0f)) return;
    const double off = (z - expected) / tolerance;
    if (std::abs(off) < 1.0) {
      counts.agreeing += 1.0 - off * off;
      counts.score += 1.0 - off * off;
    } else if (off > 0.0) {
      counts.beyond += 1.0;
      counts.score -= 1.0;
    } else {
      counts.score -= SmallFrames::occluded;
      counts.front += 1.0;
    }
  };
  SmallFrames::for_each_part(small, view, [&](int first, int end, int v) {
    for (int u = first; u < end; ++u) add(u, v);
  });
  return counts;
}

std::size_t Agreement::worst() const {
  return static_cast<std::size_t>(
      std::ranges::min_element(given_, {}, [](const Counts& counts) { return counts.score; }) -
      given_.begin());
}

Rating Agreement::rate_masks(const Hypothesis& hypothesis) {
  Rating rating;
  const bool is_given = given_.empty();
  const auto frames = static_cast<double>(compared());
  for (std::size_t k = 0; k < compared(); ++k) {
    calibration::Overlap overlap;
    overlap.add(small_.render(T_camera_link(hypothesis, k)).depth, small_.frames()[k].moved);
    const auto both = static_cast<double>(overlap.both);
    if (is_given) given_.push_back({.score = overlap.share(), .agreeing = both});
    rating.score += overlap.share() / frames;
    rating.more += (both - given_[k].agreeing) / frames;
  }
  rating.fit = rating.score;
  return rating;
}

Rating Agreement::rate_colors(const Hypothesis& hypothesis) {
  const std::vector<SmallFrames::Small>& small = small_.frames();
  const auto score = [&](std::size_t shift) {
    return colors_->score([&](std::size_t k) {
      const KeptFrame* const of = small[(k + shift) % small.size()].frame;
      return T_camera_link(hypothesis, static_cast<std::size_t>(of - setup_.frames.data()));
    });
  };
  Rating rating{.score = score(0)};
  const double by_others = score(calibration::half_of(small.size()));
  const double most = std::max(std::abs(rating.score), std::abs(by_others));
  if (most > 0.0) rating.fit = (rating.score - by_others) / most;
  if (given_.empty()) {
    given_.resize(setup_.frames.size(), {.score = 1.0});
    for (const SmallFrames::Small& one : small) {
      const auto at = static_cast<std::size_t>(one.frame - setup_.frames.data());
      calibration::Overlap overlap;
      overlap.add(small_.render(T_camera_link(hypothesis, at)).depth, one.moved);
      given_[at].score = overlap.share();
    }
  }
  return rating;
}

Rating Agreement::rate(const Hypothesis& hypothesis, double tolerance) {
  small_.set_camera(hypothesis.camera);
  if (colors_) return rate_colors(hypothesis);
  if (setup_.has_masks()) return rate_masks(hypothesis);
  if (setup_.parent == 0) small_.find_moved(hypothesis.depth_factor);
  const bool is_given = given_.empty();
  Counts sum, of_given, all_given;
  double used = 0.0;
  const auto add = [](Counts& to, const Counts& counts) {
    to.score += counts.score;
    to.most += counts.most;
    to.agreeing += counts.agreeing;
    to.beyond += counts.beyond;
    to.front += counts.front;
  };
  for (std::size_t k = 0; k < setup_.frames.size(); ++k) {
    if (!is_given) add(all_given, given_[k]);
    if (hypothesis.T_root_link[k].empty()) continue;
    ++used;
    const Counts counts = count(hypothesis, k, static_cast<float>(tolerance));
    add(sum, counts);
    if (is_given)
      given_.push_back(counts);
    else
      add(of_given, given_[k]);
  }
  if (used == 0.0) return {.score = -1.0};
  const double pixels = used * small_.camera().width() * small_.camera().height();
  Rating rating{.score = small_.score(sum.score, sum.most, used)};
  if (!is_given) rating.more = (sum.agreeing - of_given.agreeing) / used;
  if (!is_given)
    rating.score +=
        small_.score(all_given.score, all_given.most, static_cast<double>(setup_.frames.size())) -
        small_.score(of_given.score, of_given.most, used);
  if (sum.agreeing > (setup_.is_scanner ? least_of_scan : least_agreeing) * pixels)
    rating.fit = sum.agreeing / (sum.agreeing + sum.beyond + SmallFrames::occluded * sum.front);
  return rating;
}

}  // namespace penumbra::diagnosis
