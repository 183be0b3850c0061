// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace penumbra::test {

/// A domain of DDS that no other test on this machine uses while this lives. Participants of this
/// process and of those that it starts stay on this machine (ROS_LOCALHOST_ONLY).
class LoneDomain {
 public:
  LoneDomain() {
    setenv("ROS_LOCALHOST_ONLY", "1", 1);
    unsetenv("CYCLONEDDS_URI");
    unsetenv("ROS_DOMAIN_ID");
    for (int i = 0; i < domains; ++i) {
      id_ = first_domain + (getpid() + i) % domains;
      const auto file =
          std::filesystem::temp_directory_path() / ("penumbra_test_domain_" + std::to_string(id_));
      lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
      if (lock_ >= 0) close(lock_);
    }
    throw std::runtime_error("every domain is taken");
  }
  ~LoneDomain() { close(lock_); }
  LoneDomain(const LoneDomain&) = delete;
  LoneDomain& operator=(const LoneDomain&) = delete;

  [[nodiscard]] int id() const { return id_; }

 private:
  // Ports of domains from 102 on are those that Linux gives to anybody. 0 and its neighbours are
  // people's own.
  static constexpr int first_domain = 10, domains = 90;

  int id_ = 0;
  int lock_ = -1;  // of a file
};

}  // namespace penumbra::test
