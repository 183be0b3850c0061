// SPDX-License-Identifier: Apache-2.0
// What penumbra live refuses, and how it ends; what it publishes is tested against Fast DDS.
#include "../support/opengl.hpp"
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

/// Runs it on a graph of this machine alone.
Outcome live(const Words& options, const Words& environment = {}) {
  return penumbra(Words{"live"} + options,
                  environment + Words{"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
}

TEST(LiveCommand, RefusesWhatCannotBe) {
  const std::vector<std::pair<Words, std::string>> all = {
      {{"--domain", "233"}, "--domain"},
      {{"--camera", "left"}, "NAME=TOPIC"},
      {{"--camera", "a=/x", "--camera", "a=/y"}, "given twice"},
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
      {{"--robot", "/nonexistent.urdf"}, "nonexistent.urdf"},  // before any camera is there
      {{"--pose", "/nonexistent.csv"}, "nonexistent.csv"},
      {{"--search"}, "--search: is of --calibrate"},
      {{"--calibrate", "--cloud", "/points"}, "--calibrate: is of cameras"},
      {{"--duration", "0.5"}, "no camera was found: "}};
  for (const auto& [options, named] : all) {
    const Outcome outcome = live(options);
    expect_failed(outcome, {named});
    EXPECT_LE(count_lines(outcome.err), 2U) << outcome.err;  // and what the kernel's buffers lack
  }
}

TEST(LiveCommand, ADeviceThatCannotDrawIsRefusedBeforeTheGraphIsJoined) {
  const Words line = {"--depth-topic", "/depth", "--duration", "0.5", "--renderer", "gl"};
  const Outcome without = live(line, no_egl_driver);
  expect_refused(without, {"renderer 'gl'"});
  EXPECT_EQ(without.out, "");
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  const Outcome other = live(line + Words{"--gl-device", "99"});
  expect_refused(other, {"there is no device 99"});
  EXPECT_EQ(other.out, "");
}

TEST(LiveCommand, EndsByItselfAndSaysWhatCame) {
  const TemporaryFolder folder;
  const fs::path summary = folder.path() / "live.json";
  write_file(summary, "former");
  expect_failed(live({"--duration", "0.3", "--summary", summary}), {"no camera was found"});
  EXPECT_EQ(read_file(summary), "former");

  expect_failed(live({"--depth-topic", "/nobody/depth", "--duration", "1.2", "--summary", summary}),
                {"nothing was judged", "no publisher of /nobody/depth"});
  expect_has(read_file(summary), {"\"received\": 0", "\"renderer\": null"});
}

}  // namespace
}  // namespace penumbra::test
