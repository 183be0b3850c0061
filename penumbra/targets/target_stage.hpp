// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/error.hpp>
#include <penumbra/base/recent_values.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/target_track.hpp>

namespace penumbra {

/// Judges targets on one kind of samples: the pixels of images, or the rays of scans.
class SampleJudge {
 public:
  SampleJudge() = default;
  SampleJudge(const SampleJudge&) = delete;
  SampleJudge& operator=(const SampleJudge&) = delete;
  virtual ~SampleJudge() = default;

  /// Judges a checked target on a frame whose pose is known. `memory`: null for a target that is
  /// judged alone. `motion`: TargetView::motion. Throws InputError for why it is unknown.
  virtual Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                          const std::optional<Eigen::Vector2d>& motion) = 0;

  /// Returns the pixel of a point in the sensor's frame; null if there is none.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& /*p*/) const {
    return std::nullopt;
  }
  /// A new frame is judged. Its depth may be kept for targets that come late.
  virtual void begin(const LabelledFrame& /*frame*/) {}
  /// Returns the frame of an earlier stamp. `poses`: of it; null: not known. Throws InputError if
  /// it is not kept.
  virtual const LabelledFrame& earlier(std::int64_t /*stamp*/, const PoseResult* /*poses*/) {
    throw InputError("its stamp is not the frame's");
  }
  virtual void forget() {}
};

/// Judges a frame's targets and follows those with handling.
class TargetStage {
 public:
  /// A target is forgotten after so many calls without it.
  static constexpr std::size_t forgotten_after = 300;

  /// `image_frame`: of the camera; null: targets of any image frame are judged. Robot and judge
  /// must outlive this.
  TargetStage(const Robot& robot, SampleJudge& judge, std::optional<std::string> image_frame);

  /// Judges the targets on the frame, or late ones on an earlier frame. Stores the frame.
  /// `forecasts`: TargetReport::forecast of each; empty: there are none.
  void judge(std::span<const Target> targets, const LabelledFrame& frame,
             std::span<const Forecast> forecasts = {});

  /// Feeds the estimates of the targets just judged to their trackers.
  void track(std::span<const Target> targets, const LabelledFrame& frame);

  /// The results for these targets; valid until the next judge().
  [[nodiscard]] std::span<const TargetReport> reports() const { return reports_; }
  /// The wall time of judge() and track() for them, milliseconds.
  [[nodiscard]] double elapsed_ms() const { return judge_ms_.value_or(0) + track_ms_.value_or(0); }

  void forget(std::string_view name);
  void forget_all();

 private:
  /// What is remembered of a target from frame to frame.
  struct Record {
    TargetMemory memory;
    std::size_t call = 0;                    ///< the last call with it
    std::size_t times = 0;                   ///< its occurrences in that call
    bool is_new = true;                      ///< its handling has not been read
    std::optional<std::int64_t> last_stamp;  ///< the last stamp that was judged
    std::optional<std::int64_t> last_held;   ///< the last frame in which a link carried it
    std::optional<TargetTrack> track;
    const PoseResult* judged_poses = nullptr;   ///< of the frame it was judged on, if in order
    std::optional<Eigen::Vector2d> good_pixel;  ///< of the track when last visible

    /// Whether a frame is older than one that was judged.
    [[nodiscard]] bool is_late(const LabelledFrame& frame) const {
      return frame.stamp() && last_stamp && *frame.stamp() < *last_stamp;
    }
  };
  void begin(std::span<const Target> targets, const LabelledFrame& frame,
             std::span<const Forecast> forecasts);
  void judge(const Target& target, const LabelledFrame& frame, Record& record,
             TargetReport& report);
  void check(const Target& target, Record& record) const;
  const LabelledFrame& frame_of(const Target& target, const LabelledFrame& frame);
  static void hold(const PlacedBody& body, const LabelledFrame& frame, Record& record,
                   TargetReport& report);
  Judgement judge_on(const LabelledFrame& frame, const Target& target, Record& record);
  [[nodiscard]] std::optional<Eigen::Vector2d> track_pixel(const PoseResult& poses,
                                                           const Record& record) const;
  void track(const Target& target, const PoseResult& poses, Record& record, TargetReport& report);
  Outcome feed(const TargetEstimate& estimate, std::int64_t stamp, TargetTrack& track);

  const Robot& robot_;
  SampleJudge& samples_;
  std::optional<std::string> image_frame_;
  RecentValues<PoseResult> recent_poses_;
  std::unordered_map<std::string, Record> records_;  // by name
  std::deque<Record> nameless_;                      // of this call's targets without identity
  std::size_t calls_ = 0;
  std::optional<std::int64_t> newest_stamp_;
  std::vector<Record*> given_;  // of this call's targets
  std::vector<TargetReport> reports_;
  std::optional<double> judge_ms_, track_ms_;
};

}  // namespace penumbra
