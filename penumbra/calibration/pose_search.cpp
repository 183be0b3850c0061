// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/mesh/simplified.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::calibration {
namespace {

constexpr int small_width = 128;            // pixels
constexpr double coarse = 0.004;            // metres by which meshes are simplified
constexpr double wide = 0.05;               // metres between measured and virtual depth that agree
constexpr double sharp = 0.02;              // the same at the end
constexpr float before_background = 0.05f;  // metres nearer than the background: something moved
constexpr float noise_of_square = 0.03f;    // metres per square metre of depth

constexpr double worst_score = -2.0;
constexpr double occluded = 0.3;  // cost of a pixel with something before the robot
constexpr double missed = 0.5;    // cost of a pixel with something that moved and is not the robot

constexpr double distance_sigma = 0.3;  // of the logarithm of the robot's distance by its size

// The cross-entropy method (Rubinstein 1999).
constexpr int population = 120;
constexpr std::size_t elite = 15;

Image<float> made_small(const Image<float>& depth, const Intrinsics& small) {
  const int block = depth.width() / small.width();
  Image<float> out(small.width(), small.height());
  for (int v = 0; v < small.height(); ++v)
    for (int u = 0; u < small.width(); ++u)
      for (int i = 0; i < block * block && out(u, v) == 0.0f; ++i) {
        const int at = (i + block / 2 * (block + 1)) % (block * block);  // from the middle on
        out(u, v) = depth(u * block + at % block, v * block + at / block);
      }
  return out;
}

/// 1 where the mask covers at least half of a pixel.
Image<std::uint8_t> made_small(const Image<std::uint8_t>& mask, const Intrinsics& small) {
  const int block = mask.width() / small.width();
  Image<std::uint8_t> out(small.width(), small.height());
  for (int v = 0; v < small.height(); ++v)
    for (int u = 0; u < small.width(); ++u) {
      int covered = 0;
      for (int i = 0; i < block * block; ++i)
        covered += mask(u * block + i % block, v * block + i / block) != 0;
      out(u, v) = 2 * covered >= block * block;
    }
  return out;
}

}  // namespace

PoseSearch::PoseSearch(const Model& model, const Intrinsics& camera,
                       std::span<const KeptFrame* const> frames, bool camera_is_fixed,
                       std::uint64_t seed)
    : model_(model),
      small_([&] {
        const int block = std::max(1, camera.width() / small_width);
        return camera.binned(block, std::min(block, camera.height()));
      }()),
      seed_(seed),
      tolerance_(wide) {
  for (const KeptFrame* frame : frames)
    if (frame->depth.empty())
      frames_.push_back({frame, {}, made_small(frame->mask, small_)});
    else
      frames_.push_back({frame, made_small(frame->depth, small_),
                         Image<std::uint8_t>(small_.width(), small_.height())});
  if (camera_is_fixed) {
    if (!frames.front()->depth.empty()) find_moved();
    find_anchors();
  }
  const Robot& robot = model.robot();
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    std::vector<PreparedMesh>& meshes = meshes_.emplace_back();
    for (const PreparedMesh& mesh : robot.meshes(link))
      meshes.emplace_back(simplified(static_cast<const TriangleMesh&>(mesh), coarse));
  }
  std::vector<Body> bodies;
  for (const auto& meshes : meshes_) bodies.push_back({"", meshes});
  renderer_ = make_depth_renderer(Backend::cpu, small_, bodies);
}

/// The background is the median depth; the noise of stereo cameras grows with the depth's square.
void PoseSearch::find_moved() {
  std::vector<float> depths;
  for (int v = 0; v < small_.height(); ++v)
    for (int u = 0; u < small_.width(); ++u) {
      depths.clear();
      for (const Small& small : frames_)
        if (small.depth(u, v) > 0.0f) depths.push_back(small.depth(u, v));
      if (depths.size() < KeptFrames::least) continue;
      const float middle = detail::median(depths);
      const float limit = middle - before_background - noise_of_square * middle * middle;
      for (Small& small : frames_)
        small.moved(u, v) = small.depth(u, v) > 0.0f && small.depth(u, v) < limit;
    }
}

/// Where the moving part of the robot is: the mean of what moved in the image, and of the links.
/// Without depth, where all of the robot is, at the distance at which its links are spread as far
/// as the mask.
void PoseSearch::find_anchors() {
  const auto report = model_.robot().report();
  std::vector<bool> moves(report.size());
  const bool has_depth = !frames_.front().depth.empty();
  for (const Small& small : frames_)
    for (std::size_t link = 0; link < report.size(); ++link)
      moves[link] =
          moves[link] || (report[link].drawn &&
                          (!has_depth || !small.frame->T_root_link[link].isApprox(
                                             frames_.front().frame->T_root_link[link], 0.02)));
  for (const Small& small : frames_) {
    Anchor anchor;
    double pixels = 0.0, links = 0.0, seen_spread = 0.0, spread = 0.0;
    for (int v = 0; v < small_.height(); ++v)
      for (int u = 0; u < small_.width(); ++u) {
        if (small.moved(u, v) == 0) continue;
        const Eigen::Vector3d ray = small_.ray(u, v);
        anchor.in_camera += has_depth ? ray * small.depth(u, v) : ray;
        seen_spread += ray.squaredNorm();
        pixels += 1.0;
      }
    for (std::size_t link = 0; link < report.size(); ++link) {
      if (!moves[link]) continue;
      const Eigen::Vector3d centre = small.frame->T_root_link[link] * report[link].bounds.center();
      anchor.in_root += centre;
      spread += centre.squaredNorm();
      links += 1.0;
    }
    if (pixels == 0.0 || links == 0.0) continue;
    anchor = {anchor.in_camera / pixels, anchor.in_root / links};
    if (!has_depth) {  // two of the three dimensions are seen
      seen_spread = seen_spread / pixels - anchor.in_camera.squaredNorm();
      spread = (spread / links - anchor.in_root.squaredNorm()) * 2.0 / 3.0;
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

double PoseSearch::overlap(const Small& small, const ImageView<const float>& robot) const {
  std::size_t both = 0, either = 0;
  for (int v = 0; v < small_.height(); ++v)
    for (int u = 0; u < small_.width(); ++u) {
      const bool rendered = robot(u, v) > 0.0f, seen = small.moved(u, v) != 0;
      both += rendered && seen;
      either += rendered || seen;
    }
  return static_cast<double>(both) / static_cast<double>(std::max<std::size_t>(either, 1));
}

double PoseSearch::score(const State& state, std::size_t every_frame) {
  double sum = 0.0, most = 0.0, overlaps = 0.0;
  const auto tolerance = static_cast<float>(tolerance_);
  for (std::size_t k = 0; k < frames_.size(); k += every_frame) {
    const Small& small = frames_[k];
    const VirtualDepthView robot = renderer_->render(model_.T_camera_link(*small.frame, state));
    if (small.depth.empty()) {
      overlaps += overlap(small, robot.depth);
      continue;
    }
    for (int v = 0; v < small_.height(); ++v)
      for (int u = 0; u < small_.width(); ++u) {
        const float expected = robot.depth(u, v);
        const float measured = small.depth(u, v) > 0.0f ? state.corrected(small.depth(u, v)) : 0.0f;
        if (expected > 0.0f) {
          most += 1.0;
          if (!(measured > 0.0f)) continue;
          if (measured > expected + tolerance)
            sum -= 1.0;
          else if (measured < expected - tolerance)
            sum -= occluded;
          else
            sum += 1.0;
        } else if (small.moved(u, v) != 0) {
          most += 1.0;
          sum -= missed;
        }
      }
  }
  const std::size_t count = (frames_.size() + every_frame - 1) / every_frame;
  if (frames_.front().depth.empty()) return overlaps / static_cast<double>(count);
  // A robot out of view, or a speck, is as bad as one in free space.
  const double least = 0.01 * small_.width() * small_.height() *
                       static_cast<double>(frames_.size()) / static_cast<double>(every_frame);
  return (sum - std::max(0.0, least - most)) / std::max(most, least);
}

/// A normal distribution of small motions in the camera's frame, which stay within `bounds`.
Eigen::Isometry3d PoseSearch::climb(Eigen::Isometry3d mean, const Twist& sigma, int rounds,
                                    const Bounds& bounds) {
  std::mt19937_64 random(seed_++);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 6, 6> factor = sigma.asDiagonal();
  struct Tried {
    double score;
    Twist twist;
  };
  double best_score = score(mean);
  Eigen::Isometry3d best = mean;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Tried> tried;
    for (int i = 0; i < population; ++i) {
      Twist twist;
      for (double& value : twist) value = normal(random);
      twist = factor * twist;
      const Eigen::Isometry3d pose = mean * motion(twist);
      tried.push_back({bounds.hold(pose) ? score(pose) : worst_score, twist});
    }
    std::partial_sort(tried.begin(), tried.begin() + elite, tried.end(),
                      [](const Tried& a, const Tried& b) { return a.score > b.score; });
    if (tried.front().score > best_score) {
      best_score = tried.front().score;
      best = mean * motion(tried.front().twist);
    }
    Twist centre = Twist::Zero();
    for (std::size_t i = 0; i < elite; ++i) centre += tried[i].twist / elite;
    Eigen::Matrix<double, 6, 6> covariance =
        Eigen::Matrix<double, 6, 6>::Identity() * 1e-7;  // (0.3 mm, 0.02 degrees)^2
    for (std::size_t i = 0; i < elite; ++i)
      covariance += (tried[i].twist - centre) * (tried[i].twist - centre).transpose() / elite;
    factor = dense::lower_factor(covariance);
    mean = mean * motion(centre);
  }
  return best;
}

Eigen::Isometry3d PoseSearch::near(const Eigen::Isometry3d& start) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(0.06);
  tolerance_ = 2.0 * wide;
  const Bounds bounds{start};
  Eigen::Isometry3d pose = climb(start, sigma, 8, bounds);
  tolerance_ = wide;
  pose = climb(pose, 0.5 * sigma, 8, bounds);
  tolerance_ = sharp;
  return climb(pose, 0.15 * sigma, 6, bounds);
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
  const bool has_depth = !frames_.front().depth.empty();
  const double scale = has_depth ? 1.0 : std::exp(distance_sigma * normal(random));
  for (const Anchor& anchor : anchors_)
    T.translation() += (anchor.in_root - T.linear() * anchor.in_camera * scale) / anchors_.size();
  T.translation() += 0.15 * any();
  return T;
}

std::vector<Eigen::Isometry3d> PoseSearch::candidates(
    const std::optional<Eigen::Isometry3d>& around) {
  constexpr std::size_t few_frames = 3;
  const std::size_t guesses = around ? 1500 : 20000, tried = around ? 5 : 32, kept = around ? 1 : 4;
  struct Candidate {
    double score;
    Eigen::Isometry3d pose;
  };
  std::vector<Candidate> candidates;
  const auto keep_best = [&](std::size_t count) {
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    candidates.resize(std::min(candidates.size(), count));
  };
  std::mt19937_64 random(seed_++);
  tolerance_ = 2.0 * wide;
  const std::size_t every_frame = std::max<std::size_t>(1, frames_.size() / few_frames);
  for (std::size_t i = 0; i < guesses; ++i) {
    const Eigen::Isometry3d pose = guess(random, around);
    candidates.push_back({score(pose, every_frame), pose});
  }
  keep_best(tried);
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(0.2), Eigen::Vector3d::Constant(0.1);
  if (around) sigma *= 0.5;
  tolerance_ = wide;
  for (Candidate& candidate : candidates) {
    candidate.pose = climb(candidate.pose, sigma, 6, {});
    candidate.score = score(candidate.pose);
  }
  keep_best(kept);
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(candidates.size());
  for (const Candidate& candidate : candidates) poses.push_back(near(candidate.pose));
  return poses;
}

}  // namespace penumbra::calibration
