// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <io/files/frame_pattern.hpp>

namespace penumbra::io {
namespace {

std::string expand(const std::string& pattern, std::int64_t index) {
  return FramePattern(pattern, "/r").file(index).string();
}

TEST(FramePattern, PutsTheNumberIn) {
  EXPECT_EQ(expand("depth_%d.png", 0), "/r/depth_0.png");
  EXPECT_EQ(expand("depth_%d.png", 1234567890123), "/r/depth_1234567890123.png");
  EXPECT_EQ(expand("d/%06d.npy", 42), "/r/d/000042.npy");
  EXPECT_EQ(expand("d/%06d.npy", 12345678), "/r/d/12345678.npy");
  EXPECT_EQ(expand("%d/depth.png", 3), "/r/3/depth.png");
  EXPECT_EQ(expand("100%%_%d", 3), "/r/100%_3");
  EXPECT_EQ(expand("/abs/%d.png", 3), "/abs/3.png");
  EXPECT_EQ(FramePattern("%d.png", "/with%d/%s").file(1).string(), "/with%d/%s/1.png");
}

TEST(FramePattern, RefusesEverythingElse) {
  for (const char* pattern : {"depth.png", "", "%", "%d_%d.png", "%s.png", "%n", "%6d.png", "%00d",
                              "%0d", "%010d", "%x", "%06", "%d%", "%-5d", "%%d", "%ld"})
    EXPECT_THROW(FramePattern(pattern, "/r"), InputError) << pattern;
}

TEST(FramePattern, FindsTheFilesThatExist) {
  using Indices = std::vector<std::int64_t>;
  const test::TemporaryFolder folder;
  for (const char* name :
       {"d_0.png", "d_12.png", "d_7.png", "d_07.png", "d_-1.png", "d_+2.png", "d_.png", "d_8.npy",
        "dd_3.png", "d_4.png.part", "d_99999999999999999999.png", "n/000002.npy", "n/0000020.npy",
        "n/1000000.npy", "n/3.npy", "5/depth.png", "6/color.png", "100%_3"})
    folder.write(name, "x");
  const auto existing = [&](const char* pattern) {
    return FramePattern(pattern, folder.path()).existing();
  };
  EXPECT_EQ(existing("d_%d.png"), (Indices{0, 7, 12}));
  EXPECT_EQ(existing("d_%02d.png"), (Indices{7, 12}));
  EXPECT_EQ(existing("n/%06d.npy"), (Indices{2, 1000000}));
  EXPECT_EQ(existing("d_1%d.png"), Indices{2});
  EXPECT_EQ(existing("d_%d2.png"), Indices{1});
  EXPECT_EQ(existing("%d/depth.png"), Indices{5});
  EXPECT_EQ(existing("100%%_%d"), Indices{3});
  EXPECT_EQ(existing("nowhere/%d.png"), Indices{});
  const std::string absolute = (folder.path() / "d_%d.npy").string();
  EXPECT_EQ(FramePattern(absolute, "/r").existing(), Indices{8});
}

TEST(FramePattern, FindsFilesOfFramesByTheirTimes) {
  using Names = std::vector<std::string>;
  struct Case {
    const char* pattern;
    Names files;     // in the folder
    Names expected;  // by frame, from 0
  };
  constexpr std::int64_t one_second = 1'000'000'000, start = 1'700'000'000 * one_second;
  const FrameStamps stamps{
      {0, start}, {1, start + one_second / 10}, {2, start + one_second / 5 + 300}};
  const Case cases[] = {
      {"%t.png",  // TUM's; the third is rounded
       {"1700000000.100000.png", "1700000000.200000.png", "1700000000.000000.png", "note.txt",
        "99999999999999999999.png", "9999999999999.1.png", ".1.png", "1..1.png",
        "1.0123456789.png"},
       {"1700000000.000000.png", "1700000000.100000.png", "1700000000.200000.png"}},
      {"d_%t.png", {"d_1700000000.1.png", "d_1.png"}, {"", "d_1700000000.1.png", ""}},
      {"%t.npy", {"1700000000100000.npy"}, {"", "1700000000100000.npy", ""}},
      {"%t.npy", {"1700000000205.npy", "1700000000100.npy"}, {"", "1700000000100.npy", ""}},
      {"%t.png",  // two of one frame: the nearer
       {"1700000000.100500.png", "1700000000.100100.png"},
       {"", "1700000000.100100.png", "", "1700000000.100500.png"}}};
  for (const Case& each : cases) {
    const test::TemporaryFolder folder;
    for (const std::string& name : each.files) folder.write(name, "x");
    const FramePattern pattern(each.pattern, folder.path(), stamps);
    EXPECT_EQ(pattern.fault(), "");
    for (std::size_t i = 0; i < each.expected.size(); ++i) {
      const auto file = pattern.file(static_cast<std::int64_t>(i));
      const std::string& name = each.expected[i];
      EXPECT_EQ(std::filesystem::exists(file), !name.empty()) << file;
      EXPECT_TRUE(name.empty() || file == folder.path() / name) << file;
    }
  }
  const test::TemporaryFolder folder;
  folder.write("1700000005.000000.png", "x");  // of no row: behind the last frame
  folder.write("1700000000.000000.png", "x");
  EXPECT_EQ(FramePattern("%t.png", folder.path(), stamps).existing(),
            (std::vector<std::int64_t>{0, 3}));
  const FrameStamps later{{0, start + one_second}};
  EXPECT_HAS(FramePattern("%t.png", folder.path(), later).fault(), "stamp");
  EXPECT_THROW(FramePattern("%t.png", folder.path()), InputError) << "no stamps are known there";
}

}  // namespace
}  // namespace penumbra::io
