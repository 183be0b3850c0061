// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "../support/run_length.hpp"
#include "fixtures.hpp"

#include <iostream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

namespace penumbra::test {
namespace {

/// Runs the program by itself, with nothing between: the peak of its resident memory, MB.
double peak_memory_mb(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), PENUMBRA_PROGRAM);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int refused = posix_spawn(&child, argv[0], &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  EXPECT_EQ(refused, 0);
  int status = -1;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

TEST(Footprint, ARunOnTheRecordingStaysSmall) {
  PENUMBRA_REQUIRE_DATA();
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  constexpr double budget = 200.0;  // MB
  const TemporaryFolder folder;
  const std::string recording = data_folder() / "xarm7_realsense";
  for (const char* save : {"labels", "vdi,labels,links,overlay"}) {
    const double peak = peak_memory_mb({"run", recording, "-o", folder.path(), "--save", save});
    std::cout << "--save " << save << ": " << peak << " MB\n";
    EXPECT_LT(peak, budget);
    EXPECT_GT(peak, 1.0) << "not measured";
  }
}

}  // namespace
}  // namespace penumbra::test
