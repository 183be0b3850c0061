// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "../support/run_length.hpp"
#include "json.hpp"
#include "program.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
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

/// A binary STL file of a grid of 2 side^2 triangles in the plane z = 0, 1 mm wide.
std::string grid_stl(std::uint32_t side) {
  const std::uint32_t count = 2 * side * side;
  std::string stl(84 + 50 * static_cast<std::size_t>(count), '\0');
  std::memcpy(&stl[80], &count, sizeof(count));
  std::size_t at = 84 + 12;  // after the normal, which is 0
  const auto put = [&](std::uint32_t i, std::uint32_t j) {
    const float point[3] = {0.001F * static_cast<float>(i), 0.001F * static_cast<float>(j), 0.0F};
    std::memcpy(&stl[at], point, sizeof(point));
    at += sizeof(point);
  };
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      put(i, j), put(i + 1, j), put(i, j + 1);
      at += 50 - 36;
      put(i, j + 1), put(i + 1, j), put(i + 1, j + 1);
      at += 50 - 36;
    }
  }
  return stl;
}

TEST(InspectFull, AMeshOfFiveMillionTrianglesIsReported) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  if (!is_full_run()) GTEST_SKIP() << "skipped: PENUMBRA_FULL is not set";
  constexpr std::uint32_t side = 1582;
  const TemporaryFolder folder;
  write_file(folder.path() / "big.stl", grid_stl(side));
  write_file(folder.path() / "big.urdf",
             "<robot name=\"big\"><link name=\"base\"><collision><geometry>"
             "<mesh filename=\"big.stl\"/></geometry></collision></link></robot>");
  const Outcome outcome = penumbra({"inspect", folder.path() / "big.urdf", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json link = Json::parse(outcome.out)["links"][0];
  std::cout << link["load_ms"] << " ms\n";
  EXPECT_EQ(link["triangles"], 2 * side * side);
  EXPECT_EQ(link["watertight"], false);
  EXPECT_NEAR(link["size_m"][0].get<double>(), 0.001 * side, 1e-6);
  EXPECT_GT(link["load_ms"], 0.0);
}

}  // namespace
}  // namespace penumbra::test
