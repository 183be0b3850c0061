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

#include <penumbra/base/recent_values.hpp>
#include <penumbra/pipeline/frame_judge-inl.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/targets/target_track.hpp>

namespace penumbra {

/// Returns the body that carries a target of this name, or null.
[[nodiscard]] const PlacedBody* find_body(const PoseResult& poses, std::string_view name);

/// Judges a frame's targets and follows those with handling.
class TargetStage {
 public:
  /// A target is forgotten after so many calls without it.
  static constexpr std::size_t forgotten_after = 300;

  /// `image_frame`: of the camera; null: targets of any image frame are judged. Robot and judge
  /// must outlive this.
  TargetStage(const Robot& robot, FrameJudge& judge, std::optional<std::string> image_frame);

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

  /// As Pipeline::attach_target; `poses`: of the last frame, null: it was not judged.
  [[nodiscard]] AttachedBody attach(const Target& target, std::string_view link,
                                    const PoseResult* poses) const;

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
  FrameJudge& judge_;
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
