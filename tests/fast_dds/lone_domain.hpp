// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::test {

/// A domain of DDS that no other test on this machine uses while this lives. Participants of this
/// process and of those that it starts stay on this machine (ROS_LOCALHOST_ONLY).
class LoneDomain {
 public:
  LoneDomain();
  ~LoneDomain();
  LoneDomain(const LoneDomain&) = delete;
  LoneDomain& operator=(const LoneDomain&) = delete;

  [[nodiscard]] int id() const { return id_; }

 private:
  int id_ = 0;
  int lock_ = -1;  // of a file
};

}  // namespace penumbra::test
