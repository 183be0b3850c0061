// SPDX-License-Identifier: Apache-2.0
// What penumbra live refuses, and how it ends; what it publishes is tested against Fast DDS.
#include "../support/opengl.hpp"
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

struct Refused {
  std::vector<std::string> options;
  std::string words;
};

TEST(LiveCommand, RefusesWhatCannotBe) {
  const std::vector<Refused> all = {
      {{"--domain", "233"}, "--domain"},
      {{"--camera", "left"}, "NAME=TOPIC"},
      {{"--camera", "a=/x", "--camera", "a=/y"}, "given twice"},
      {{"--camera", "1=/b"}, "--camera: '1' is not a name"},
      {{"--camera", "a b=/b"}, "--camera: 'a b' is not a name"},
      {{"--remap", "/nobody:=/b"}, "--remap '/nobody': no topic has this name"},
      {{"--remap", "/penumbra/labels:=/b", "--camera", "a=/x"}, "--remap '/penumbra/labels'"},
      {{"--camera", "a=/x y"}, "not a topic name"},
      {{"--camera", "a=/x", "--depth-topic", "/y"}, "leave one of them out"},
      {{"--camera", "a=/x", "--camera", "b=/y", "--parent", "base"}, "--parent"},
      {{"--publish", "labels,depth"}, "'depth'"},
      {{"--queue", "0"}, "--queue"},
      {{"--remap", "/a=/b"}, "FROM:=TO"},
      {{"--namespace", "a b"}, "--namespace"},
      {{"--duration", "-1"}, "--duration"},
      {{"--points-stride", "0"}, "--points-stride: '0' is not a whole number from 1 to 64"},
      {{"--points-voxel", "x"}, "--points-voxel"},
      {{"--points-voxel", "0.0001"}, "points_voxel: expected 0, or 0.001 m or more"},
      {{"--points-rate", "-1"}, "--points-rate"},
      {{"--port", "70000"}, "--port"},
      {{"--address", "0.0.0.0"}, "give --port, too"},
      {{"--summary", "/nonexistent/live.json"}, "/nonexistent/live.json"},
      {{"--robot", "/nonexistent.urdf", "--depth-topic", "/depth"}, "nonexistent.urdf"},
      {{"--pose", "/nonexistent.csv", "--depth-topic", "/depth"}, "nonexistent.csv"},
      {{"--robot", "/nonexistent.urdf"}, "nonexistent.urdf"},  // before any camera is there
      {{"--pose", "/nonexistent.csv"}, "nonexistent.csv"},
      {{"--duration", "0.5"}, "no camera was found: "}};
  for (const Refused& refused : all) {
    std::vector<std::string> arguments = refused.options;
    arguments.insert(arguments.begin(), "live");
    const Outcome outcome = penumbra(arguments, {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
    EXPECT_EQ(outcome.status, 2) << refused.words << outcome.err;
    EXPECT_NE(outcome.err.find(refused.words), std::string::npos) << outcome.err;
    EXPECT_LE(count_lines(outcome.err), 2U) << outcome.err;  // and what the kernel's buffers lack
  }
}

TEST(LiveCommand, ADeviceThatCannotDrawIsRefusedBeforeTheGraphIsJoined) {
  const auto expect_refused = [](std::vector<std::string> renderer, const std::string& words,
                                 std::vector<std::string> environment = {}) {
    renderer.insert(renderer.begin(), {"live", "--depth-topic", "/depth", "--duration", "0.5"});
    environment.emplace_back("ROS_LOCALHOST_ONLY=1");
    environment.emplace_back("ROS_DOMAIN_ID=231");
    const Outcome outcome = penumbra(renderer, environment);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  expect_refused({"--renderer", "gl"}, "renderer 'gl'", no_egl_driver);
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  expect_refused({"--renderer", "gl", "--gl-device", "99"}, "there is no device 99");
}

TEST(LiveCommand, EndsByItselfAndSaysWhatCame) {
  const TemporaryFolder folder;
  const std::string summary = folder.path() / "live.json";
  const Outcome outcome = penumbra(
      {"live", "--depth-topic", "/nobody/depth", "--duration", "1.2", "--summary", summary},
      {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  expect_has(outcome.err, {"nothing was judged"});
  expect_has(outcome.err, {"no publisher of /nobody/depth"});
  expect_has(read_file(summary), {"\"received\": 0"});
  expect_has(read_file(summary), {"\"renderer\": null"});
}

TEST(LiveCommand, AFormerSummaryStaysWhereNothingIsSummed) {
  const TemporaryFolder folder;
  const std::string summary = folder.path() / "live.json";
  write_file(summary, "former");
  const Outcome outcome = penumbra({"live", "--duration", "0.3", "--summary", summary},
                                   {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  expect_has(outcome.err, {"no camera was found"});
  EXPECT_EQ(read_file(summary), "former");
}

}  // namespace
}  // namespace penumbra::test
