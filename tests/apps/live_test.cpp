// SPDX-License-Identifier: Apache-2.0
// What penumbra live refuses, and how it ends; what it publishes is tested against Fast DDS.
#include "../support/opengl.hpp"
#include "program.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <io/dds/participant.hpp>

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
      {{"--camera", "a=/x", "--camera", "a=/y"}, "another name"},
      {{"--camera", "1=/b"}, "--camera: '1' is not a name"},
      {{"--camera", "a b=/b"}, "--camera: 'a b' is not a name"},
      {{"--remap", "/nobody:=/b"}, "--remap '/nobody': nothing here is called so"},
      {{"--remap", "/penumbra/labels:=/b", "--camera", "a=/x"}, "--remap '/penumbra/labels'"},
      {{"--camera", "a=/x y"}, "not a topic name"},
      {{"--camera", "a=/x", "--depth-topic", "/y"}, "leave one of them out"},
      {{"--camera", "a=/x", "--camera", "b=/y", "--parent", "base"}, "--parent"},
      {{"--publish", "labels,depth"}, "'depth'"},
      {{"--queue", "0"}, "--queue"},
      {{"--remap", "/a=/b"}, "FROM:=TO"},
      {{"--namespace", "a b"}, "--namespace"},
      {{"--duration", "-1"}, "--duration"},
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
    if (!io::has_dds() && outcome.err.find("cyclonedds-dev") != std::string::npos) continue;
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

TEST(LiveCommand, HelpNamesItsOwnDefaults) {
  const auto line_of = [](const std::string& command, const std::string& option) {
    const std::string help = penumbra({command, "--help"}).out;
    const std::size_t begin = help.find("\n  " + option + " ");
    EXPECT_NE(begin, std::string::npos) << option;
    return help.substr(begin, help.find('\n', begin + 1) - begin);
  };
  struct Default {
    std::string option, of_run, of_live;
  };
  const std::vector<Default> all = {
      {"--poses", "default: joints, else tf", "default: joints, never tf by itself"},
      {"--joint-topic", "default: /joint_states, or the only one;", "default: joint_states;"},
      {"--geometry", "default: the recording's, else collision", "default: collision"}};
  for (const Default& one : all) {
    EXPECT_NE(line_of("run", one.option).find(one.of_run), std::string::npos) << one.option;
    EXPECT_NE(line_of("live", one.option).find(one.of_live), std::string::npos) << one.option;
  }
}

TEST(LiveCommand, EndsByItselfAndSaysWhatCame) {
  if (!io::has_dds()) GTEST_SKIP() << "this build has no DDS";
  const TemporaryFolder folder;
  const std::string summary = folder.path() / "live.json";
  const Outcome outcome = penumbra(
      {"live", "--depth-topic", "/nobody/depth", "--duration", "1.2", "--summary", summary},
      {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("no image was judged"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("no publisher of /nobody/depth"), std::string::npos) << outcome.err;
  EXPECT_NE(read_file(summary).find("\"received\": 0"), std::string::npos);
  EXPECT_NE(read_file(summary).find("\"renderer\": null"), std::string::npos);
}

TEST(LiveCommand, AFormerSummaryStaysWhereNothingIsSummed) {
  if (!io::has_dds()) GTEST_SKIP() << "this build has no DDS";
  const TemporaryFolder folder;
  const std::string summary = folder.path() / "live.json";
  write_file(summary, "former");
  const Outcome outcome = penumbra({"live", "--duration", "0.3", "--summary", summary},
                                   {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("live.json is left as it was"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_file(summary), "former");
}

}  // namespace
}  // namespace penumbra::test
