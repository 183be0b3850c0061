// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// What is doubtful of a sequence of frames though each of them may be ok.
class SequenceNotes {
 public:
  /// How far a joint may be past a limit, rad or m: limits are written with two decimals, and arms
  /// overshoot.
  static constexpr double revolute_slack = 0.01;
  static constexpr double prismatic_slack = 0.001;

  /// `robot` must outlive this.
  explicit SequenceNotes(const Robot& robot);

  /// `positions`: those of the frame, in the order of Robot::variables(); empty if not known.
  void add(const FrameReport& report, std::span<const double> positions);

  /// A line each: a robot that is in no frame whose pose is known, stamps that do not rise from
  /// frame to frame, joints beyond their limits.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  /// A frame whose stamp is not after the one before.
  struct LateStamp {
    std::size_t index = 0;
    std::int64_t stamp = 0, before = 0;  // nanoseconds
  };

  void add_stamp(const FrameReport& report);
  void add_positions(std::span<const double> positions);
  [[nodiscard]] std::string stamp_line() const;
  [[nodiscard]] std::string limit_line() const;

  const Robot& robot_;
  std::size_t posed_frames_ = 0;
  bool robot_seen_ = false;
  std::optional<std::int64_t> last_stamp_;
  std::optional<LateStamp> first_late_;
  std::size_t late_stamps_ = 0;
  std::vector<std::size_t> frames_beyond_;  // of each joint
};

}  // namespace penumbra
