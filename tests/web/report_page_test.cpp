// SPDX-License-Identifier: Apache-2.0
// `penumbra run --report`, and what goes into its page.
#include "../apps/fixtures.hpp"
#include "../support/page_json.hpp"

#include <penumbra/pipeline/frame.hpp>

#include <io/files/result_folder.hpp>
#include <io/web/key_frames.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::test {
namespace {

using ReportPage = TinyTest;

TEST_F(ReportPage, HoldsReportAndKeyFrames) {
  succeed(run({"--report"}));
  const std::string page = read_file(out("report.html"));
  EXPECT_EQ(page_json(page, "penumbra-report"), report());
  const Json frames = page_json(page, "penumbra-pictures");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]["index"], 0);
  EXPECT_EQ(frames[1]["index"], 2);
  EXPECT_EQ(frames[0]["image"].get<std::string>().substr(0, 27), "data:image/jpeg;base64,/9j/");

  // The next run takes it away, and does not take another's.
  succeed(run());
  EXPECT_FALSE(fs::exists(out("report.html")));
  write_file(out("report.html"), "<!doctype html><p>mine");
  succeed(run());
  EXPECT_TRUE(fs::exists(out("report.html")));
  expect_failed(run({"--report"}), {"report.html"});
}

TEST_F(ReportPage, NamesCannotEndItsScripts) {
  const Json written{{"input", "</script><script>alert(1)</script><!-- "}};
  const std::vector<io::PagePicture> pictures = {{0, "data:", "</script>\xff"}};
  const std::string page = io::report_page(written.dump(), pictures);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page_json(page, "penumbra-report"), written);
  EXPECT_EQ(page_json(page, "penumbra-pictures")[0]["caption"], "</script>\ufffd");
  EXPECT_TRUE(page.starts_with(io::page_begin));
}

/// The key frames of a report whose verdict changes every `period` frames.
std::vector<std::size_t> key_frames_of(std::size_t frames, std::size_t period) {
  io::KeyFrames key_frames;
  const Image<Rgb8> picture(16, 8);
  for (std::size_t i = 0; i < frames; ++i) {
    TargetReport target;
    target.name = "cup";
    target.verdict = i / period % 2 == 0 ? Verdict::visible : Verdict::hidden;
    FrameReport report;
    report.targets = {&target, 1};
    key_frames.add(report, picture.view());
  }
  std::vector<std::size_t> indices;
  for (const io::PagePicture& each : key_frames.pictures()) indices.push_back(each.index);
  return indices;
}

TEST(KeyFrames, AreFirstLastAndChanges) {
  EXPECT_EQ(key_frames_of(100, 30), (std::vector<std::size_t>{0, 30, 60, 90, 99}));
  const auto many = key_frames_of(1000, 1);
  EXPECT_EQ(many.size(), io::KeyFrames::most_frames);
  EXPECT_EQ(many.front(), 0U);
  EXPECT_EQ(many.back(), 999U);
}

}  // namespace
}  // namespace penumbra::test
