// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// A pose where a camera could be mounted.
struct CameraCandidate {
  std::string name;
  std::string link;  ///< that would carry it; empty: the root
  Eigen::Isometry3d T_link_camera = Eigen::Isometry3d::Identity();  ///< metres, optical frame
};

/// What each candidate sees of each target in each frame.
class CandidateViews {
 public:
  CandidateViews(std::size_t candidates, std::size_t frames, std::size_t targets)
      : candidates_(candidates),
        frames_(frames),
        targets_(targets),
        verdicts_(candidates * frames * targets, Verdict::unknown),
        reasons_(candidates) {}

  [[nodiscard]] std::size_t candidates() const { return candidates_; }
  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] std::size_t targets() const { return targets_; }

  [[nodiscard]] Verdict at(std::size_t candidate, std::size_t frame, std::size_t target) const {
    return verdicts_[(candidate * frames_ + frame) * targets_ + target];
  }
  [[nodiscard]] Verdict& at(std::size_t candidate, std::size_t frame, std::size_t target) {
    return verdicts_[(candidate * frames_ + frame) * targets_ + target];
  }

  /// Returns the share of the frames in which a target has this verdict.
  [[nodiscard]] double share(std::size_t candidate, std::size_t target, Verdict verdict) const;

  /// Why a verdict of this candidate is unknown, and in which frame: the first one. Empty: none is.
  [[nodiscard]] const std::string& unknown(std::size_t candidate) const {
    return reasons_[candidate];
  }
  [[nodiscard]] std::string& unknown(std::size_t candidate) { return reasons_[candidate]; }

 private:
  std::size_t candidates_, frames_, targets_;
  std::vector<Verdict> verdicts_;
  std::vector<std::string> reasons_;
};

/// The camera that is planned with.
struct PlannedCamera {
  Camera camera;   ///< targets whose origin is outside its range are out_of_view
  LabelRule rule;  ///< its tolerance separates robot and target
};

/// Judges each frame's targets as each candidate would see them if only the robot, and what it
/// carries, could hide them: from renders, without depth images. The frames have the poses of all
/// links, and the same number of targets in the same order, whose shapes are given in the root's or
/// a link's frame; std::monostate: not found. Each frame is judged alone, without hysteresis. A
/// camera inside a link, a part of the robot nearer than DepthRenderer::near_plane and a body that
/// cannot be drawn make what would be seen unknown. `threads`: how many, at least 1; the result
/// does not depend on it. Calls `step` after each candidate's frame, on any thread but never twice
/// at once. Throws InputError for an unknown link and as Pipeline does, and std::invalid_argument
/// for frames with different numbers of targets.
[[nodiscard]] CandidateViews judge_candidates(const Robot& robot, const PlannedCamera& camera,
                                              std::span<const CameraCandidate> candidates,
                                              std::span<const Frame> motion, int threads,
                                              const std::function<void()>& step = {});

/// Cameras that together see more than others.
struct CameraSet {
  std::vector<std::size_t> candidates;  ///< indices, ascending
  std::vector<double> visible;          ///< by target: share of frames in which one of them sees it
  double mean = 0.0;                    ///< of `visible`
};

/// All sets are compared, up to this number: on one core that takes 10 s for 1,000 frames with
/// three targets, and 45 s for 5,000.
inline constexpr std::size_t max_compared_sets = 100'000'000;

/// Throws InputError for `most` outside of 1 to the number of candidates, and for more than
/// max_compared_sets sets of up to `most` candidates.
void check_camera_sets(std::size_t candidates, std::size_t most);

/// Returns the set with the largest mean for each size from 1 to `most`. Of equal sets the one
/// whose cameras each see more wins, then the first in the candidates' order. Throws as
/// check_camera_sets does.
[[nodiscard]] std::vector<CameraSet> best_cameras(const CandidateViews& views, std::size_t most);

}  // namespace penumbra
