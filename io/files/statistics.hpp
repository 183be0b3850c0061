// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra::io {

/// Order statistics of samples. p99: the smallest sample that at least 99 % do not exceed; median:
/// the larger of the middle two.
struct Quantiles {
  double min = 0.0, median = 0.0, p99 = 0.0, max = 0.0;
};

/// Returns nothing without samples.
[[nodiscard]] std::optional<Quantiles> quantiles(std::vector<double> samples);

/// A stage's name and its member in a report.
struct Stage {
  std::string_view name;
  std::optional<double> StageTimes::*time;
};
inline constexpr std::array stages = {
    Stage{"kinematics", &StageTimes::kinematics}, Stage{"render", &StageTimes::render},
    Stage{"classify", &StageTimes::classify}, Stage{"targets", &StageTimes::targets}};

/// The labels of a scan's points and their numbers in a report.
inline constexpr std::array<std::pair<std::string_view, std::size_t PixelCounts::*>, 6>
    point_counts = {{{"clear", &PixelCounts::clear},
                     {"front", &PixelCounts::front},
                     {"occluded", &PixelCounts::occluded},
                     {"unknown", &PixelCounts::unknown},
                     {"beyond", &PixelCounts::beyond},
                     {"fringe", &PixelCounts::fringe}}};

/// A message of frames, and their number. Messages that differ only in numbers of frames, files and
/// lines are one reason.
struct Reason {
  std::string message;  ///< the first frame's
  std::size_t frames = 0;
  std::size_t first = 0;  ///< index of its first frame
};

/// A status other than ok: how often it occurred, and why.
struct Fault {
  static constexpr std::size_t max_reasons = 16;  ///< messages may differ in every frame

  FrameStatus status = FrameStatus::ok;
  std::size_t frames = 0;
  std::vector<Reason> reasons;    ///< the first ones, in order
  std::size_t other_reasons = 0;  ///< frames of further ones
};

/// The sums of one target.
struct TargetStatistics {
  std::string name;
  std::array<std::size_t, 6> verdicts{};  ///< frames by Verdict
  std::array<std::size_t, 4> handled{};   ///< frames by Source; all 0 if it is not handled
  std::array<std::size_t, 5> outcomes{};  ///< estimates by Outcome
  std::string reason;                     ///< why it was unknown first
  std::size_t first_unknown = 0;          ///< index of that frame

  [[nodiscard]] std::size_t frames(Verdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
};

/// Sums over many frames.
class Statistics {
 public:
  void add(const FrameReport& report);
  void set_drift(const Drift& drift) { drift_ = drift; }
  void set_diagnosis(const Diagnosis& diagnosis) { diagnosis_ = diagnosis; }

  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] std::size_t bad_frames() const;

  /// Returns the number of frames that are ok, or drawn without a link.
  [[nodiscard]] std::size_t usable_frames() const { return usable_frames_; }

  [[nodiscard]] const std::vector<Fault>& faults() const { return faults_; }

  /// Returns sums over the frames; `robot` over those that have it.
  [[nodiscard]] const PixelCounts& pixels() const { return pixels_; }

  /// Returns the most parts of a scan; 0: the frames are images.
  [[nodiscard]] std::size_t parts() const { return parts_; }

  /// Returns the targets in the order of their first frames.
  [[nodiscard]] const std::vector<TargetStatistics>& targets() const { return targets_; }

  /// Returns how far the camera has moved from its calibration.
  [[nodiscard]] const Drift& drift() const { return drift_; }

  /// Returns what is wrong with the setup.
  [[nodiscard]] const Diagnosis& diagnosis() const { return diagnosis_; }

  /// Returns whether the robot is in some usable frame (of scans: some point lies on it), and not
  /// measured as free space in most of its pixels or points; if not, nothing that was judged can be
  /// trusted.
  [[nodiscard]] bool shows_robot() const;

  /// Returns milliseconds of one of `stages`; nothing if it never ran.
  [[nodiscard]] std::optional<Quantiles> timing(std::size_t stage) const;

 private:
  void add_fault(const FrameReport& report);
  void add_target(const TargetReport& target, std::size_t place, std::size_t frame);

  std::size_t frames_ = 0;
  std::size_t usable_frames_ = 0;
  std::vector<Fault> faults_;
  PixelCounts pixels_;
  std::size_t parts_ = 0;
  std::vector<TargetStatistics> targets_;
  std::unordered_map<std::string, std::size_t> target_places_;
  std::array<std::vector<double>, stages.size()> times_;
  Drift drift_;
  Diagnosis diagnosis_;
};

}  // namespace penumbra::io
