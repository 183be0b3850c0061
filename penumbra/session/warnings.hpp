// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

class ScanImage;

/// Finds likely mistakes in the setup of a sequence of frames, each of which may be ok.
class Warnings {
 public:
  /// Tolerance of joint limits, rad or m: limits are written with two decimals, and arms overshoot.
  static constexpr double revolute_slack = 0.01;
  static constexpr double prismatic_slack = 0.001;

  /// A larger fraction of front or beyond in the robot's measured pixels makes pose and depth
  /// doubtful; a smaller fraction of measured pixels makes the depth doubtful.
  static constexpr double most = 0.5;
  static constexpr double nearly_none = 0.05;

  /// A larger fraction of beyond in a scan's points in the robot's direction is not noise.
  static constexpr double likely_wrong = 0.1;

  /// Targets with a note of their own; more would hide the other lines.
  static constexpr std::size_t most_target_notes = 10;

  /// If all stamps are closer, nanoseconds, they have another unit: no depth camera gives 1000
  /// images a second.
  static constexpr std::uint64_t shortest_period = 1'000'000;

  /// For scans.
  explicit Warnings(const Robot& robot);
  /// `pipeline`: which judges the frames; `camera`, `config`: the pipeline's.
  Warnings(const Pipeline& pipeline, const Camera& camera, const PipelineConfig& config);

  /// `frame`: the report's.
  void add(const FrameReport& report, const Frame& frame);
  /// Adds that frame, which is a scan, drawn as an image.
  void add(ScanImage& image);

  /// Returns a line for each likely mistake. What a wrong setup looks like is left out where the
  /// diagnosis names the cause.
  [[nodiscard]] std::vector<std::string> lines() const;
  /// Takes a tenth of a second, or about a second if something looks wrong.
  [[nodiscard]] const Diagnosis& diagnosis() const;

  /// Returns the number of different poses of the robot, up to SetupCheck::most; 0 for scans
  /// that are not drawn.
  [[nodiscard]] std::size_t poses() const { return sensor_ ? sensor_->setup.poses() : 0; }

 private:
  /// A frame whose stamp is not after the one before.
  struct LateStamp {
    std::size_t index = 0;
    std::int64_t stamp = 0, before = 0;  // nanoseconds
  };

  void add_stamp(const FrameReport& report);
  void add_targets(const FrameReport& report);
  void add_scan_lines(std::vector<std::string>& lines) const;
  [[nodiscard]] std::string depth_line() const;

  /// What compares frames with the setup.
  struct Sensor {
    SetupCheck setup;
    ImageSpace image;
    int fringe_reach;  // pixels; 0: scans, whose fringe has other causes
  };

  Robot robot_;
  std::optional<Sensor> sensor_;
  bool has_depth_ = true;                       // of the camera
  mutable std::optional<Diagnosis> diagnosis_;  // of the frames so far
  std::size_t posed_frames_ = 0;
  bool is_scanner_ = false;         // the sensor measures points
  std::size_t labelled_scans_ = 0;  // not all unknown; among the posed frames
  bool robot_seen_ = false;
  std::size_t robot_pixels_ = 0, measured_ = 0, front_ = 0, beyond_ = 0;  // of frames with depth
  std::size_t uncovered_ = 0;  // pixels of the frame with the most of them
  std::optional<std::int64_t> last_stamp_;
  std::optional<LateStamp> first_late_;
  std::size_t late_stamps_ = 0;
  std::uint64_t longest_period_ = 0;                 // nanoseconds between two stamps that rise
  std::size_t forgotten_ = 0;                        // times, with targets in the frame
  std::size_t not_handled_ = 0;                      // frames
  std::string body_note_;                            // the first one
  std::map<std::string, std::string> target_notes_;  // the first one of each target
  std::shared_ptr<const Trajectory> plan_;           // of the last frame
  std::vector<std::string> plan_notes_;              // of the first plan that has any
  std::vector<std::size_t> frames_beyond_;           // of each joint
  std::vector<std::size_t> frames_near_;             // of each link
};

}  // namespace penumbra
