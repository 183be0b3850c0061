// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/calibration/problem.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>

namespace penumbra::diagnosis {

using calibration::SmallFrames;
using Cause = Diagnosis::Cause;
using Poses = std::vector<Eigen::Isometry3d>;

/// How well the rendered robot and the frames agree: with depth, masks, or colours.
struct Rating {
  /// At most 1: all of the robot's pixels agree. Of a hypothesis for some of the frames only, what
  /// it gains there, more than the given setup's score of all frames.
  double score = 0.0;
  /// Share of the robot's measured pixels that agree, where those with something in front count
  /// less; 0 if there are nearly none. Of masks the intersection over union; of colours what is
  /// explained with the frames' joints and not with those of other frames.
  double fit = 0.0;
  /// How many pixels agree that do not in the given setup, by frame; 0 of colours. A setup that
  /// only moves the robot out of view explains nothing.
  double more = 0.0;
};

/// A setup that would be right if `cause` were the fault of the given one.
struct Hypothesis {
  Cause cause = Cause::none;
  Intrinsics camera;
  double depth_factor = 1.0;  ///< true depth by given depth
  bool along_ray = false;     ///< given depth is the distance along the ray
  Eigen::Isometry3d T_parent_camera = Eigen::Isometry3d::Identity();
  std::vector<Poses> T_root_link;  ///< of each frame; empty: this frame does not count
  std::string message;             ///< what is wrong and what mends it
  Rating rating = {};
  /// If the mistake has an amount: what the setup would be with another one, and how far apart the
  /// amounts are that mistakes() tries.
  std::function<Hypothesis(double)> with_amount = {};
  double amount = 0.0, step = 0.0;
};

/// What is given.
struct Setup {
  std::span<const KeptFrame> frames;
  const Intrinsics& camera;      ///< of the frames
  const Intrinsics& raw_camera;  ///< as it is given, with a lens whose distortion they are free of
  const Robot& robot;
  std::size_t parent;
  Eigen::Isometry3d T_parent_camera;
  bool is_scanner = false;  ///< as of SetupCheck

  [[nodiscard]] bool has_depth() const { return !frames.front().depth.empty(); }
  [[nodiscard]] bool has_masks() const { return !has_depth() && !frames.front().mask.empty(); }
  [[nodiscard]] bool has_colors() const { return !has_depth() && !has_masks(); }
};

/// Metres: depth that is nowhere above it may be normalised to 0 to 1.
inline constexpr float normalised = 1.0F + 1e-6F;
[[nodiscard]] float largest_depth(const Setup& setup);

/// The setup as given.
[[nodiscard]] Hypothesis as_given(const Setup& setup);
/// Setups that differ from the given one by a single mistake of those that people make.
[[nodiscard]] std::vector<Hypothesis> mistakes(const Setup& setup);

/// Rates hypotheses on small images.
class Agreement {
 public:
  Agreement(const Setup& setup, std::span<const KeptFrame* const> frames);

  /// `tolerance`: metres between measured and virtual depth at which agreement has fallen to 0.
  [[nodiscard]] Rating rate(const Hypothesis& hypothesis, double tolerance);
  /// Returns the number of the frame in which the given setup, rated first, agrees least.
  [[nodiscard]] std::size_t worst() const;
  /// Returns the number of frames that are compared: colour images of another view than most are
  /// not.
  [[nodiscard]] std::size_t compared() const { return small_.frames().size(); }

 private:
  struct Counts {
    double score = 0.0, most = 0.0, agreeing = 0.0, beyond = 0.0, front = 0.0;
  };
  [[nodiscard]] Poses T_camera_link(const Hypothesis& hypothesis, std::size_t frame) const;
  [[nodiscard]] Counts count(const Hypothesis& hypothesis, std::size_t frame, float tolerance);
  [[nodiscard]] Rating rate_masks(const Hypothesis& hypothesis);
  [[nodiscard]] Rating rate_colors(const Hypothesis& hypothesis);

  const Setup& setup_;
  SmallFrames small_;
  std::optional<calibration::ColorScore> colors_;  // null: depth or masks
  std::vector<Counts> given_;                      // of each frame, as the setup is given
};

}  // namespace penumbra::diagnosis
