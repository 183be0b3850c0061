// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/recent_values.hpp>
#include <penumbra/cloud/scan.hpp>
#include <penumbra/pipeline/frame_judge-inl.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Labels scans by the robot's poses while they were measured, and judges targets on their rays.
/// Its images are of one row, a pixel for each point.
class ScanLabeller final : public FrameJudge {
 public:
  /// Throws InputError for a robot without geometry, a target_history out of range, and as
  /// CloudLabeller.
  ScanLabeller(const Robot& robot, const CloudConfig& config);

  /// Labels a scan. The result refers to the frame and is valid until the next call. What is
  /// attached at the scan's begin is labelled, too; the first scan with others takes as long as the
  /// construction.
  LabelledFrame label(const Frame& frame, PoseStage& poses) override;

  Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                  const std::optional<Eigen::Vector2d>& motion) override;
  void begin(const LabelledFrame& frame) override;
  const LabelledFrame& earlier(std::int64_t stamp, const PoseResult* poses) override;
  void forget() override { recent_.clear(); }

  void set_rule(const CloudRule& rule) override;

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

  Robot robot_;
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
  std::size_t parts_ = 1;
  Labels now_;                   // of the last scan
  PoseResult begin_ = {};        // the poses at its begin
  RecentValues<Labels> recent_;  // of scans with points of their own
  LabelledFrame late_;
};

}  // namespace penumbra
