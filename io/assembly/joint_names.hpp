// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace penumbra::io {

/// Names that joint states have for the robot's joints: MESSAGE=JOINT with one '*' on each side,
/// which stands for the same text, as "left/*=*".
class JointNames {
 public:
  /// Throws InputError for another form. Empty: the names are those of the joints.
  explicit JointNames(std::string_view text);

  [[nodiscard]] bool are_same() const { return are_same_; }
  /// Returns the joint that a name of a message stands for; the name itself if it has another form.
  [[nodiscard]] std::string joint_of(std::string_view name) const;

 private:
  bool are_same_;
  std::array<std::string, 2> message_, joint_;  // before and after the '*'
};

}  // namespace penumbra::io
