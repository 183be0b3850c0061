// SPDX-License-Identifier: Apache-2.0
// The folder that a command writes its results into.
#include "../support/errors.hpp"
#include "files.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <io/files/result_folder.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;
using test::expect_refused;

constexpr const char* report_text = "{\n  \"penumbra\": \"1\"}";

class ResultFolderTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  [[nodiscard]] fs::path out(const char* name) const { return out() / name; }
  [[nodiscard]] ResultFolderOptions options(bool force = false) const {
    return {.path = out(),
            .report = {"found.json", json_begin},
            .others = {{"pose.csv"}, {"part_*.stl"}, {"report.html", page_begin}},
            .frames = {{FramePattern("images/%06d.png", out())}},
            .force = force};
  }
  void expect_refusal(const std::string& named, bool force = false) const {
    expect_refused([&] { ResultFolder results(options(force)); }, {named});
  }
  /// As a command that succeeds.
  void write_results() const {
    ResultFolder results(options());
    results.begin();
    results.add_text("part_a.stl", "a");
    results.add_text("pose.csv", "pose");
    write(results.frame_file(0, 7), "image");
    results.add_text("found.json", report_text);
    EXPECT_FALSE(fs::exists(out("pose.csv"))) << "results appear at the end";
    results.finish();
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  test::TemporaryFolder folder_;
};

TEST_F(ResultFolderTest, ReplacesFormerResults) {
  write_results();
  write_results();
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
  EXPECT_EQ(test::read_bytes(out("found.json")), report_text);
  const std::vector<const char*> others = {"notes.txt", "images/notes.txt", "images/7.png",
                                           "images/000008.jpg"};
  for (const char* const name : others) write(out(name), "mine");
  write(out("images/000008.png"), "of a former result");
  write_results();
  for (const char* const name : others) EXPECT_EQ(test::read_bytes(out(name)), "mine") << name;
  EXPECT_EQ(test::read_bytes(out("images/000007.png")), "image");
  EXPECT_FALSE(fs::exists(out("images/000008.png")));
}

TEST_F(ResultFolderTest, AFailureLeavesNoResult) {
  write_results();
  {
    ResultFolder results(options());
    EXPECT_TRUE(fs::exists(out("pose.csv"))) << "until the inputs are read";
    results.begin();
    results.add_text("pose.csv", "pose");
    write(results.frame_file(0, 7), "image");
  }
  EXPECT_TRUE(fs::is_empty(out("images")));
  fs::remove(out("images"));
  EXPECT_TRUE(fs::is_empty(out()));
}

TEST_F(ResultFolderTest, AFailureNextToOtherFilesDoesNotBlockTheNext) {
  write_results();
  write(out("notes.txt"), "mine");
  { ResultFolder(options()).begin(); }
  EXPECT_FALSE(fs::exists(out("found.json")));
  write_results();
  EXPECT_EQ(test::read_bytes(out("notes.txt")), "mine");
}

TEST_F(ResultFolderTest, AnEmptyFolderOfItsOwnGoes) {
  { const ResultFolder results(options()); }
  EXPECT_FALSE(fs::exists(out()));
  fs::create_directory(out());
  { const ResultFolder results(options()); }
  EXPECT_TRUE(fs::exists(out())) << "the user's";
}

TEST_F(ResultFolderTest, FilesOfOthersAreRefused) {
  fs::create_directory(out());
  for (const char* const name : {"notes.txt", "pose.csv", "found.json"}) {
    write(out(name), "mine");
    expect_refused([&] { ResultFolder results(options()); }, {"out", "found.json"});
    EXPECT_EQ(test::read_bytes(out(name)), "mine");
    fs::remove(out(name));
  }
  write_results();
  write(out("report.html"), "mine");
  expect_refusal("report.html");
  EXPECT_EQ(test::read_bytes(out("report.html")), "mine");
  expect_refused([&] { ResultFolder results({.path = out("report.html"), .report = {"a"}}); },
                 {"report.html", "it is a file"});
}

TEST_F(ResultFolderTest, ForcedItTakesAnyFolder) {
  fs::create_directory(out());
  write(out("notes.txt"), "mine");
  ResultFolder results(options(true));
  results.begin();
  results.add_text("found.json", report_text);
  results.finish();
  EXPECT_EQ(test::read_bytes(out("notes.txt")), "mine");
}

TEST_F(ResultFolderTest, NothingIsWrittenThroughALink) {
  write_results();
  const fs::path precious = folder_.write("precious", "mine");
  fs::remove(out("pose.csv"));
  fs::create_symlink(precious, out("pose.csv"));
  expect_refusal("pose.csv");
  ResultFolder results(options(true));
  results.begin();
  results.add_text("pose.csv", "pose");
  results.finish();
  EXPECT_EQ(test::read_bytes(precious), "mine");
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
}

TEST_F(ResultFolderTest, FramesAreNotWrittenThroughALink) {
  const fs::path precious = folder_.write("precious", "mine");
  fs::create_directories(out("images"));
  fs::create_symlink(precious, out("images/000007.png"));
  write(out("images/000008.png"), "mine");
  {
    ResultFolder results(options(true));
    results.begin();
    EXPECT_TRUE(fs::exists(out("images/000007.png"))) << "no report says that it is a result";
    write(results.frame_file(0, 7), "image");
    results.add_text("found.json", report_text);
    results.finish();
  }
  EXPECT_EQ(test::read_bytes(precious), "mine");
  EXPECT_EQ(test::read_bytes(out("images/000007.png")), "image");
  EXPECT_EQ(test::read_bytes(out("images/000008.png")), "mine");
  fs::remove_all(out("images"));
  fs::create_directory_symlink(folder_.path(), out("images"));
  expect_refusal("link", true);
}

TEST_F(ResultFolderTest, APipeIsRefused) {
  write_results();
  fs::remove(out("pose.csv"));
  ASSERT_EQ(mkfifo(out("pose.csv").c_str(), 0600), 0);
  expect_refusal("pose.csv");
}

TEST_F(ResultFolderTest, AnInputStaysUntilItIsMadeAgain) {
  write_results();
  ResultFolder results(options());
  const fs::path inputs[] = {folder_.path() / "nowhere", out() / "." / "pose.csv"};
  results.begin(inputs);
  EXPECT_FALSE(fs::exists(out("part_a.stl")));
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
  results.add_text("pose.csv", "another");
  results.finish();
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "another");
}

TEST_F(ResultFolderTest, BelongsToOneCommandAtATime) {
  const ResultFolder results(options());
  expect_refusal("another program");
}

TEST_F(ResultFolderTest, TakesOverFromAKilledCommand) {
  fs::create_directory(out());
  write(PendingFile::part_of(out("found.json")), "{");
  write(PendingFile::part_of(out("part_a.stl")), "cut");
  fs::create_directory(out("images"));
  write(out("images/000008.png"), "cut");
  write_results();
  EXPECT_FALSE(fs::exists(out("images/000008.png")));
  EXPECT_FALSE(fs::exists(PendingFile::part_of(out("found.json"))));
}

}  // namespace
}  // namespace penumbra::io
