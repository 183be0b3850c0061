// SPDX-License-Identifier: Apache-2.0
// What `penumbra live` says of its renderer, and what stays of a run whose graphics device fails.
#include "../apps/program.hpp"
#include "../apps/tiny_bag.hpp"
#include "../apps/tiny_recording.hpp"
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "lone_domain.hpp"

#include <cstdlib>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using Json = nlohmann::json;

class LiveRenderers : public testing::Test {
 protected:
  LiveRenderers() {
    write_tiny_recording(folder_.path());
    tiny_bag(folder_.path()).write_mcap(folder_.path() / "bag.mcap");
  }

  /// `penumbra live` while a bag is played; it ends by itself.
  [[nodiscard]] Outcome live(std::vector<std::string> options,
                             const std::vector<std::string>& environment) const {
    const std::string id = std::to_string(domain_.id());
    const std::string play = "timeout --preserve-status -s INT 8 '" PENUMBRA_PROGRAM
                             "' play --loop --restamp --domain " +
                             id + " '" + (folder_.path() / "bag.mcap").string() + "' >/dev/null";
    const auto player = std::async(std::launch::async, [&] { return std::system(play.c_str()); });
    options.insert(
        options.begin(),
        {"live", "--domain", id, "--depth-topic", "/camera/depth/image_rect_raw", "--robot",
         folder_.path() / "tiny.urdf", "--duration", "7", "--summary", summary_});
    return penumbra(options, environment);
  }
  [[nodiscard]] Json told() const { return Json::parse(read_file(summary_)); }

  static std::size_t count(const std::string& text, const std::string& words) {
    std::size_t number = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
      ++number;
    return number;
  }

  TemporaryFolder folder_;
  LoneDomain domain_;
  std::string summary_ = folder_.path() / "live.json";
};

/// Takes no byte.
constexpr const char* full_disk = "/dev/full";

TEST_F(LiveRenderers, ASummaryThatCannotBeWrittenIsAFault) {
  if (!std::filesystem::exists(full_disk)) GTEST_SKIP() << "no " << full_disk;
  const Outcome outcome =
      penumbra({"live", "--domain", std::to_string(domain_.id()), "--depth-topic", "/nobody",
                "--duration", "0.5", "--summary", full_disk});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count(outcome.err, "--summary /dev/full: cannot be written\n"), 1U) << outcome.err;
  EXPECT_EQ(count(outcome.err, "no image was judged"), 0U) << outcome.err;
}

#ifdef PENUMBRA_FAILING_DEVICE
TEST_F(LiveRenderers, ASummaryThatCannotBeWrittenDoesNotHideTheFault) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  if (!std::filesystem::exists(full_disk)) GTEST_SKIP() << "no " << full_disk;
  summary_ = full_disk;
  const Outcome outcome =
      live({"--renderer", "gl"},
           {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=6"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(count(outcome.err, "penumbra: OpenGL: the graphics device was reset"), 1U)
      << outcome.err;
  EXPECT_EQ(count(outcome.err, "note: --summary /dev/full: cannot be written\n"), 1U)
      << outcome.err;
}

TEST_F(LiveRenderers, ADeviceThatFailsAtItsFirstDrawIsRefused) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  const Outcome outcome =
      penumbra({"live", "--domain", std::to_string(domain_.id()), "--depth-topic", "/nobody",
                "--duration", "0.5", "--summary", summary_, "--renderer", "gl"},
               {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=0"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "the graph was joined";
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_EQ(count(outcome.err, "OpenGL: the graphics device was reset"), 1U) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(summary_));
}

TEST_F(LiveRenderers, ADeviceThatFailsLeavesTheSummary) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // what fails wants to be the first library
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  write_file(summary_, "former");
  const Outcome outcome =
      live({"--renderer", "gl"},
           {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=6"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(count(outcome.err, "penumbra: OpenGL: the graphics device was reset"), 1U)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("left as it was"), std::string::npos) << outcome.err;
  const Json json = told();
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
