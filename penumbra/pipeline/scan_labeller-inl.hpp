// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target_stage.hpp>

namespace penumbra {

/// Labels scans by the robot's poses while they were measured, and judges targets on their rays.
/// Its images are of one row, a pixel for each point.
class ScanLabeller final : public SampleJudge {
 public:
  /// The robot must outlive this. Throws InputError as CloudLabeller, and for a target_history out
  /// of range.
  ScanLabeller(const Robot& robot, const CloudConfig& config);

  /// Labels a scan. The result refers to the frame and is valid until the next call. What is
  /// attached at the scan's begin is labelled, too; the first scan with others takes as long as the
  /// construction.
  LabelledFrame label(const Frame& frame, PoseStage& poses);

  Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                  const std::optional<Eigen::Vector2d>& motion) override;
  void begin(const LabelledFrame& frame) override;
  const LabelledFrame& earlier(std::int64_t stamp, const PoseResult* poses) override;
  void forget() override { kept_.clear(); }

  void set_rule(const CloudRule& rule);
  /// In how many parts the last scan was labelled, each with its own poses.
  [[nodiscard]] std::size_t parts() const { return parts_; }

 private:
  /// The labels of a scan, or why it has none.
  struct Labels {
    Scan scan = {};
    FrameStatus status = FrameStatus::ok;
    std::string message = {};
    bool are_known = false;  // not all unknown
    std::vector<std::uint8_t> labels = {};
    std::vector<std::uint16_t> links = {};
  };
  struct Kept {
    std::int64_t stamp;
    Labels scan;  // with points of its own
  };

  static LabelledFrame frame_of(const Labels& scan, const PoseResult& poses);
  void make_labeller();
  bool place(const Frame& frame, std::int64_t after, PoseStage& poses);
  bool place_parts(const Frame& frame, PoseStage& poses);
  [[nodiscard]] double movement() const;
  [[nodiscard]] std::string fault_of(const Scan& scan);
  bool refuse(FrameStatus status, std::string message);
  [[nodiscard]] bool is_reached(const Eigen::Vector3d& point,
                                const std::optional<Eigen::Vector3d>& origin) const;
  void take(const CloudLabels& found);

  const Robot& robot_;
  CloudConfig config_;
  std::optional<CloudLabeller> labeller_;
  std::vector<AttachedBody> carried_;  // the labeller's, after the links
  std::vector<double> radii_;          // of the labeller's bodies
  RobotPose pose_;
  std::vector<Eigen::Isometry3d> T_sensor_body_;  // of all parts
  std::vector<std::uint16_t> part_of_;            // of each point; empty: one part
  std::vector<std::size_t> numbers_;              // of the carried, in the report's links
  std::vector<Ball> reaches_;                     // where links of unknown pose can be
  std::vector<float> ranges_;
  std::size_t parts_ = 1, link_count_ = 0;
  Labels now_;             // of the last scan
  PoseResult begin_ = {};  // the poses at its begin
  std::int64_t history_;   // nanoseconds
  std::deque<Kept> kept_;
  LabelledFrame late_;
};

}  // namespace penumbra
