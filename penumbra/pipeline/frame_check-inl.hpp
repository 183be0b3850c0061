// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <penumbra/labels/label_work-inl.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Judges what goes into a frame before anything is computed from it.
class FrameCheck {
 public:
  /// `width`, `height`: of the depth images. `rule`: its range tells what is a measurement.
  FrameCheck(const Robot& robot, int width, int height, const LabelRule& rule,
             std::span<const std::string> missing_links);

  /// Writes the frame's status; the message says all that is wrong, in one line. Allocates nothing
  /// for a good frame. Throws InputError for doubts of what is no link.
  void operator()(const Frame& frame, FrameReport& report) const;

 private:
  void check_doubts(const LinkDoubts& doubts) const;
  FrameStatus check_source(const Frame& frame, std::string& message) const;
  FrameStatus check_poses(const Frame& frame, std::string& message) const;
  FrameStatus check_joints(const JointInput& joints, std::string& message) const;
  FrameStatus check_links(std::span<const Eigen::Isometry3d> T_root_link,
                          std::string& message) const;
  FrameStatus check_depth(const Frame& frame, FrameReport& report) const;
  [[nodiscard]] std::string without_measurement() const;

  const Robot& robot_;
  int width_;
  int height_;
  DepthRange range_;
  labelling::Rule rule_;
  std::string missing_links_;
};

/// Of a frame whose joints have that status.
[[nodiscard]] FrameStatus status_of(JointStatus joints);

/// What is missing, stale or disputed, in one line.
[[nodiscard]] std::string describe(const Robot& robot, const JointInput& joints);

/// Whether the frame's depth image can be compared.
[[nodiscard]] inline bool has_depth(FrameStatus status) {
  return status == FrameStatus::ok || status == FrameStatus::missing_link;
}

}  // namespace penumbra
