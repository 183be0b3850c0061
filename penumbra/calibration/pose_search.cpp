// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {
namespace {

constexpr double wide = 0.05;   // metres between measured and virtual depth that agree
constexpr double sharp = 0.02;  // the same at the end
constexpr double worst_score = -2.0;
constexpr double distance_sigma = 0.3;  // of the logarithm of the robot's distance by its size

// The cross-entropy method (Rubinstein 1999).
constexpr int population = 120;
constexpr std::size_t elite = 15;

/// Whether a pose is not farther from a first guess than it may be.
bool is_near(const Eigen::Isometry3d& pose, const std::optional<Eigen::Isometry3d>& guess) {
  return !guess || ((pose.translation() - guess->translation()).norm() < 0.13 &&
                    Eigen::AngleAxisd(guess->linear().transpose() * pose.linear()).angle() < 0.22);
}

}  // namespace

PoseSearch::PoseSearch(const Model& model, const Intrinsics& camera,
                       std::span<const KeptFrame* const> frames, bool camera_is_fixed,
                       std::uint64_t seed)
    : model_(model), small_(model.robot(), camera, frames), seed_(seed), tolerance_(wide) {
  if (!camera_is_fixed) return;
  if (small_.frames().front().grey.empty()) {
    small_.find_moved();
  } else {
    small_.compare_colors();
    colors_.emplace(small_);
  }
  if (!small_.frames().empty()) find_anchors();
}

/// Where the moving part of the robot is: the mean of what moved in the image, and of the links.
/// Without depth, where all of the robot is, at the distance at which its links are spread as far
/// as the mask.
void PoseSearch::find_anchors() {
  const auto report = model_.robot().report();
  std::vector<bool> moves(report.size());
  const std::vector<SmallFrames::Small>& frames = small_.frames();
  const bool has_depth = !frames.front().depth.empty();
  const bool is_whole = !has_depth && !colors_;
  for (const SmallFrames::Small& small : frames)
    for (std::size_t link = 0; link < report.size(); ++link)
      moves[link] =
          moves[link] ||
          (report[link].drawn && (is_whole || !small.frame->T_root_link[link].isApprox(
                                                  frames.front().frame->T_root_link[link], 0.02)));
  for (const SmallFrames::Small& small : frames) {
    Anchor anchor;
    double pixels = 0.0, links = 0.0, seen_spread = 0.0, spread = 0.0;
    for (int v = 0; v < small.moved.height(); ++v)
      for (int u = 0; u < small.moved.width(); ++u) {
        if (small.moved(u, v) != 1) continue;
        const Eigen::Vector3d ray = small_.camera().ray(u, v);
        anchor.in_camera += has_depth ? ray * small.depth(u, v) : ray;
        seen_spread += ray.squaredNorm();
        pixels += 1.0;
      }
    for (std::size_t link = 0; link < report.size(); ++link) {
      if (!moves[link]) continue;
      const Eigen::Vector3d centre = model_.T_root_parent(*small.frame).inverse() *
                                     small.frame->T_root_link[link] * report[link].bounds.center();
      anchor.in_parent += centre;
      spread += centre.squaredNorm();
      links += 1.0;
    }
    if (pixels == 0.0 || links == 0.0) continue;
    anchor = {anchor.in_camera / pixels, anchor.in_parent / links};
    if (!has_depth) {  // two of the three dimensions are seen
      seen_spread = seen_spread / pixels - anchor.in_camera.squaredNorm();
      spread = (spread / links - anchor.in_parent.squaredNorm()) * 2.0 / 3.0;
      if (!(seen_spread > 0.0) || !(spread > 0.0)) continue;
      anchor.in_camera *= std::sqrt(spread / seen_spread);
    }
    anchors_.push_back(anchor);
  }
}

double PoseSearch::score(const Eigen::Isometry3d& T_parent_camera, std::size_t every_frame) {
  State state;
  state.T_parent_camera = T_parent_camera;
  return score(state, every_frame);
}

double PoseSearch::score_colors(const State& state, std::size_t every_frame, std::size_t shift) {
  const std::vector<SmallFrames::Small>& all = small_.frames();
  return colors_->score(
      [&](std::size_t k) {
        return model_.T_camera_link(*all[(k + shift) % all.size()].frame, state);
      },
      every_frame, cost_of_covering_);
}

double PoseSearch::score(const State& state, std::size_t every_frame) {
  if (colors_) return score_colors(state, every_frame);
  int most = 0, missed = 0, seen = 0, past = 0, before = 0;  // pixels
  double overlaps = 0.0;
  const auto tolerance = static_cast<float>(tolerance_);
  const bool is_exact = state.depth_offset == 0.0 && state.depth_scale == 0.0;
  const std::vector<SmallFrames::Small>& frames = small_.frames();
  for (std::size_t k = 0; k < frames.size(); k += every_frame) {
    const SmallFrames::Small& small = frames[k];
    const VirtualDepthView robot = small_.render(model_.T_camera_link(*small.frame, state));
    if (small.depth.empty()) {
      Overlap overlap;
      overlap.add(robot.depth, small.moved);
      overlaps += overlap.share();
      continue;
    }
    SmallFrames::for_each_part(small, robot, [&](int first, int end, int v) {
      const float* const rendered = robot.depth.row(v);
      const float* const depths = &small.depth(0, v);
      const std::uint8_t* const moved = &small.moved(0, v);
      for (int u = first; u < end; ++u) {  // without branches: the compiler makes vectors of it
        const float expected = rendered[u];
        const float measured = is_exact ? depths[u] : state.corrected(depths[u]);
        const int is_robot = expected > 0.0f;
        const int is_seen = is_robot & (depths[u] > 0.0f) & (measured > 0.0f);
        most += is_robot;
        missed += (is_robot ^ 1) & moved[u];
        seen += is_seen;
        past += is_seen & (measured > expected + tolerance);
        before += is_seen & (measured < expected - tolerance);
      }
    });
  }
  if (frames.front().depth.empty())
    return overlaps /
           std::ceil(static_cast<double>(frames.size()) / static_cast<double>(every_frame));
  const double sum =
      seen - 2 * past - before - SmallFrames::occluded * before - SmallFrames::missed * missed;
  return small_.score(sum, most + missed,
                      static_cast<double>(frames.size()) / static_cast<double>(every_frame));
}

/// A normal distribution of small motions in the camera's frame, which stay near `around`.
Eigen::Isometry3d PoseSearch::climb(Eigen::Isometry3d mean, const Twist& sigma, int rounds,
                                    const std::optional<Eigen::Isometry3d>& around) {
  std::mt19937_64 random(seed_++);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 6, 6> factor = sigma.asDiagonal();
  double best_score = score(mean);
  Eigen::Isometry3d best = mean;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::pair<double, Twist>> tried;  // with their scores
    for (int i = 0; i < population; ++i) {
      Twist twist;
      for (double& value : twist) value = normal(random);
      twist = factor * twist;
      const Eigen::Isometry3d pose = mean * motion(twist);
      tried.emplace_back(is_near(pose, around) ? score(pose) : worst_score, twist);
    }
    std::partial_sort(tried.begin(), tried.begin() + elite, tried.end(),
                      [](const auto& a, const auto& b) { return a.first > b.first; });
    if (tried.front().first > best_score) {
      best_score = tried.front().first;
      best = mean * motion(tried.front().second);
    }
    Twist centre = Twist::Zero();
    for (std::size_t i = 0; i < elite; ++i) centre += tried[i].second / elite;
    Eigen::Matrix<double, 6, 6> covariance =
        Eigen::Matrix<double, 6, 6>::Identity() * 1e-7;  // (0.3 mm, 0.02 degrees)^2
    for (std::size_t i = 0; i < elite; ++i)
      covariance += (tried[i].second - centre) * (tried[i].second - centre).transpose() / elite;
    factor = dense::lower_factor(covariance);
    mean = mean * motion(centre);
  }
  return best;
}

Eigen::Isometry3d PoseSearch::near(const Eigen::Isometry3d& start) {
  if (!colors_) return narrowed(start, {1.0, 1.0, 1.0});
  // A robot that covers much without contrast is explained best out of view, unless covering costs
  // little at first. Then one with contrast may cover too much.
  const Eigen::Isometry3d strict = narrowed(start, {1.0, 1.0, 1.0});
  const Eigen::Isometry3d lenient = narrowed(start, {0.3, 0.6, 1.0});
  return score(strict) >= score(lenient) ? strict : lenient;
}

/// `costs`: of covering, in turn; of colours.
Eigen::Isometry3d PoseSearch::narrowed(const Eigen::Isometry3d& start,
                                       const std::array<double, 3>& costs) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(0.06);
  tolerance_ = 2.0 * wide;
  cost_of_covering_ = costs[0];
  Eigen::Isometry3d pose = climb(start, sigma, 8, start);
  tolerance_ = wide;
  cost_of_covering_ = costs[1];
  pose = climb(pose, 0.5 * sigma, 8, start);
  tolerance_ = sharp;
  cost_of_covering_ = costs[2];
  pose = climb(pose, 0.15 * sigma, 6, start);
  return colors_ ? climb(pose, 0.05 * sigma, 6, start) : pose;
}

/// A guess: any rotation, or every other time that of a camera upright in the root link, as most
/// are, or one near `around`; and the translation that brings what moved to where the robot moved.
/// A camera on a moving link is near that link, or near `around`.
Eigen::Isometry3d PoseSearch::guess(std::mt19937_64& random,
                                    const std::optional<Eigen::Isometry3d>& around) const {
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (around) {
    const Eigen::Vector3d turn = 0.15 * any();  // rad
    T.linear() = around->linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
    T.translation() = around->translation() + 0.15 * any();
    if (anchors_.empty() || random() % 2 != 0) return T;
    T.translation().setZero();
  } else {
    const Eigen::Vector3d xyz = any();
    T.linear() =
        Eigen::Quaterniond(normal(random), xyz.x(), xyz.y(), xyz.z()).normalized().matrix();
    if (anchors_.empty()) {
      T.translation() = 0.15 * any();
      return T;
    }
    if (random() % 2 == 0) {
      std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi);
      std::uniform_real_distribution<double> tilt(-1.4, 0.5);  // rad, upwards
      T.linear() =
          (Eigen::AngleAxisd(turn(random), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(tilt(random) - 0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(0.2 * normal(random), Eigen::Vector3d::UnitZ()))
              .toRotationMatrix();
    }
  }
  const bool has_depth = !small_.frames().front().depth.empty();
  const double scale = has_depth ? 1.0 : std::exp(distance_sigma * normal(random));
  for (const Anchor& anchor : anchors_)
    T.translation() += (anchor.in_parent - T.linear() * anchor.in_camera * scale) / anchors_.size();
  T.translation() += 0.15 * any();
  return T;
}

double PoseSearch::rating(const State& state, std::size_t every_frame) {
  if (!colors_) return score(state, every_frame);
  return score_colors(state, every_frame) - std::max(0.0, score_of_others(state, every_frame));
}

std::vector<Eigen::Isometry3d> PoseSearch::candidates(
    const std::optional<Eigen::Isometry3d>& around, double covering) {
  constexpr std::size_t few_frames = 3;
  cost_of_covering_ = covering;
  const std::size_t guesses = around ? 1500 : 20000, tried = around ? 5 : 32, kept = around ? 1 : 4;
  std::vector<std::pair<double, Eigen::Isometry3d>> candidates;  // with their scores
  const auto keep_best = [&](std::size_t count) {
    std::sort(candidates.begin(), candidates.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    candidates.resize(std::min(candidates.size(), count));
  };
  std::mt19937_64 random(seed_++);
  tolerance_ = 2.0 * wide;
  const std::size_t every_frame = std::max<std::size_t>(1, small_.frames().size() / few_frames);
  for (std::size_t i = 0; i < guesses; ++i) {
    const Eigen::Isometry3d pose = guess(random, around);
    candidates.emplace_back(rating({.T_parent_camera = pose, .joint_offsets = {}}, every_frame),
                            pose);
  }
  keep_best(tried);
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(0.2), Eigen::Vector3d::Constant(0.1);
  if (around) sigma *= 0.5;
  tolerance_ = wide;
  for (auto& [its_score, pose] : candidates) {
    pose = climb(pose, sigma, 6, {});
    its_score = rating({.T_parent_camera = pose, .joint_offsets = {}});
  }
  keep_best(kept);
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(candidates.size());
  for (const auto& [its_score, pose] : candidates) poses.push_back(near(pose));
  return poses;
}

}  // namespace penumbra::calibration
