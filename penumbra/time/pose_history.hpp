// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/time/transform_buffer.hpp>

namespace penumbra {

struct PoseHistoryOptions {
  JointBufferOptions joints = {};
  TransformBufferOptions transforms = {};
};

/// Joint states and transforms of a robot and its cameras, from all publishers. One serves the
/// queues of several cameras. Knows no thread.
///
/// A clock that jumps back (a bag played in a loop, a simulation started again) shows as a joint, a
/// frame or an image whose stamp is more than clock_jump before its own last one. States from
/// before and after must not mix: all but static transforms is then forgotten, and counted. What
/// comes late by less takes its place in time.
class PoseHistory {
 public:
  /// Throws InputError for options out of range.
  explicit PoseHistory(const Robot& robot, const PoseHistoryOptions& options = {});

  /// As JointBuffer::insert. States without a stamp (0, or before) are refused and counted.
  std::size_t add_joints(std::int64_t stamp, std::span<const std::string> names,
                         std::span<const double> positions, std::string_view source = {});

  /// As TransformBuffer::insert and insert_static, which count what they refuse.
  TransformInsert add_transform(std::int64_t stamp, std::string_view parent, std::string_view child,
                                const Eigen::Isometry3d& T_parent_child,
                                std::string_view source = {});
  TransformInsert add_static_transform(std::string_view parent, std::string_view child,
                                       const Eigen::Isometry3d& T_parent_child);

  /// For whoever sees other stamps of the same clock: forgets the states if `stamp` lies a jump
  /// before `newest`, and answers whether it does. `of` names what jumped, for the message.
  bool note_stamp(std::int64_t stamp, std::int64_t newest, std::string_view of);

  /// Forgets all but static transforms.
  void clear();

  [[nodiscard]] const JointBuffer& joints() const { return joints_; }
  [[nodiscard]] const TransformBuffer& transforms() const { return transforms_; }

  /// Grows whenever something is added or forgotten.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Grows whenever the states are forgotten.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }

  [[nodiscard]] std::size_t clock_jumps() const { return clock_jumps_; }
  /// One line of the last jump; empty before.
  [[nodiscard]] const std::string& last_jump() const { return last_jump_; }
  [[nodiscard]] std::size_t joint_states_without_stamp() const { return no_stamps_; }

 private:
  JointBuffer joints_;
  TransformBuffer transforms_;
  std::uint64_t revision_ = 0;
  std::uint64_t epoch_ = 0;
  std::size_t clock_jumps_ = 0;
  std::size_t no_stamps_ = 0;
  std::string last_jump_;
};

}  // namespace penumbra
