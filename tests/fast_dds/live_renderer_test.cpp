// SPDX-License-Identifier: Apache-2.0
// What stays of a `penumbra live` whose graphics device fails.
#include "../apps/program.hpp"
#include "../apps/tiny_bag.hpp"
#include "../apps/tiny_recording.hpp"
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "lone_domain.hpp"

#include <cstdlib>
#include <future>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using Json = nlohmann::json;

#ifdef PENUMBRA_FAILING_DEVICE
/// `penumbra live` while a bag is played; both end by themselves.
TEST(LiveRenderers, ADeviceThatFailsLeavesTheSummary) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // what fails wants to be the first library
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  const LoneDomain domain;
  const TemporaryFolder folder;
  const std::string id = std::to_string(domain.id()), summary = folder.path() / "live.json";
  write_tiny_recording(folder.path());
  tiny_bag(folder.path()).write_mcap(folder.path() / "bag.mcap");
  write_file(summary, "former");
  const std::string play = "timeout --preserve-status -s INT 6 '" PENUMBRA_PROGRAM
                           "' play --loop --restamp --domain " +
                           id + " '" + (folder.path() / "bag.mcap").string() + "' >/dev/null";
  const auto player = std::async(std::launch::async, [&] { return std::system(play.c_str()); });
  const Outcome outcome = penumbra(
      {"live", "--domain", id, "--depth-topic", "/camera/depth/image_rect_raw", "--robot",
       folder.path() / "tiny.urdf", "--duration", "5", "--summary", summary, "--renderer", "gl"},
      {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=6"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("OpenGL: the graphics device was reset"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("left as it was"), std::string::npos) << outcome.err;
  const Json json = Json::parse(read_file(summary));
  const std::string fault = json["fault"];
  EXPECT_TRUE(fault.starts_with("OpenGL: the graphics device was reset")) << fault;
  const Json& camera = json["cameras"][0];
  EXPECT_GT(camera["judged"], 0);
  EXPECT_EQ(camera["in_work"], 1) << "the one that failed";
  std::size_t all = 0;
  for (const char* fate : {"judged", "failed", "waiting", "in_work"})
    all += camera[fate].get<std::size_t>();
  for (const auto& [reason, images] : camera["dropped"].items()) all += images.get<std::size_t>();
  EXPECT_EQ(all, camera["received"]);
  EXPECT_EQ(camera["renderer"]["backend"], "gl");
  EXPECT_TRUE(json["cameras"][0]["renderer"]["device"].is_string());
}
#endif

}  // namespace
}  // namespace penumbra::test
