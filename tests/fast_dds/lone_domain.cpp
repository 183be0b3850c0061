// SPDX-License-Identifier: Apache-2.0
#include "lone_domain.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

// Ports of domains from 102 on are those that Linux gives to anybody. 0 and its neighbours are
// people's own.
constexpr int first_domain = 10, domains = 90;

}  // namespace

LoneDomain::LoneDomain() {
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

LoneDomain::~LoneDomain() { close(lock_); }

}  // namespace penumbra::test
