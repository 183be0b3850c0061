// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

/// What is doubtful of a sequence of frames though each of them may be ok.
class SequenceNotes {
 public:
  /// How far a joint may be past a limit, rad or m: limits are written with two decimals, and arms
  /// overshoot.
  static constexpr double revolute_slack = 0.01;
  static constexpr double prismatic_slack = 0.001;

  /// Share of the robot's measured pixels that are front or beyond above which the pose or the
  /// depth is doubted, and share of its pixels with a measurement below which the depth is.
  static constexpr double most = 0.5;
  static constexpr double nearly_none = 0.05;

  /// Stamps that are all less apart, nanoseconds, are of another unit: no depth camera gives 1000
  /// images a second.
  static constexpr std::uint64_t shortest_period = 1'000'000;

  /// What the frames are of.
  struct Source {
    ImageSpace image = ImageSpace::raw;
    bool has_sensor = true;  ///< false: depth images are no sensor's, pixels' labels tell nothing
  };

  /// `robot` must outlive this.
  explicit SequenceNotes(const Robot& robot);
  SequenceNotes(const Robot& robot, const Source& source);

  /// `positions`: those of the frame, in the order of Robot::variables(); empty if not known.
  void add(const FrameReport& report, std::span<const double> positions);

  /// A line each: a robot that is in no frame whose pose is known, robot pixels that are nearly all
  /// without measurement or mostly front or beyond, raw images that the lens model does not reach
  /// everywhere, parts of links before the near plane, stamps that do not rise from frame to frame
  /// or by less than a camera's, targets that were forgotten as stamps went back or not handled
  /// without stamps, joints beyond their limits.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  /// A frame whose stamp is not after the one before.
  struct LateStamp {
    std::size_t index = 0;
    std::int64_t stamp = 0, before = 0;  // nanoseconds
  };

  void add_pixels(const FrameReport& report);
  void add_stamp(const FrameReport& report);
  void add_positions(std::span<const double> positions);
  void add_targets(const FrameReport& report);
  [[nodiscard]] std::string depth_line() const;
  [[nodiscard]] std::string uncovered_line() const;
  [[nodiscard]] std::string near_line(std::size_t link) const;
  [[nodiscard]] std::string stamp_line() const;
  [[nodiscard]] std::string period_line() const;
  [[nodiscard]] std::string limit_line() const;

  const Robot& robot_;
  Source source_;
  std::size_t posed_frames_ = 0;
  bool robot_seen_ = false;
  std::size_t robot_pixels_ = 0, measured_ = 0, front_ = 0, beyond_ = 0;  // of frames with depth
  std::size_t uncovered_ = 0;  // pixels of the frame with the most of them
  std::optional<std::int64_t> last_stamp_;
  std::optional<LateStamp> first_late_;
  std::size_t late_stamps_ = 0;
  std::uint64_t longest_period_ = 0;        // nanoseconds between two stamps that rise
  std::size_t forgotten_ = 0;               // times, with targets in the frame
  std::size_t not_handled_ = 0;             // frames
  std::vector<std::size_t> frames_beyond_;  // of each joint
  std::vector<std::size_t> frames_near_;    // of each link
};

}  // namespace penumbra::io
