// SPDX-License-Identifier: Apache-2.0
// The folder that a command writes its results into.
#include "../support/errors.hpp"
#include "files.hpp"

#include <filesystem>
#include <fstream>
#include <string>

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
  [[nodiscard]] ResultFolderOptions options() const {
    return {.path = out(),
            .report = {"found.json", json_begin},
            .others = {{"pose.csv"}, {"part_*.stl"}, {"report.html", page_begin}}};
  }
  /// As a command that succeeds.
  void write_results() const {
    ResultFolder results(options());
    results.remove_former();
    results.add_text("part_a.stl", "a");
    results.add_text("pose.csv", "pose");
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
  write(out("notes.txt"), "mine");
  write_results();
  EXPECT_EQ(test::read_bytes(out("notes.txt")), "mine");
}

TEST_F(ResultFolderTest, AFailureLeavesNoResult) {
  write_results();
  {
    ResultFolder results(options());
    EXPECT_TRUE(fs::exists(out("pose.csv"))) << "until the inputs are read";
    results.remove_former();
    results.add_text("pose.csv", "pose");
  }
  EXPECT_TRUE(fs::is_empty(out()));
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
  expect_refused([&] { ResultFolder results(options()); }, {"report.html"});
  EXPECT_EQ(test::read_bytes(out("report.html")), "mine");
  expect_refused([&] { ResultFolder results({.path = out("report.html"), .report = {"a"}}); },
                 {"report.html", "it is a file"});
}

TEST_F(ResultFolderTest, ForcedItTakesAnyFolder) {
  fs::create_directory(out());
  write(out("notes.txt"), "mine");
  ResultFolderOptions forced = options();
  forced.force = true;
  ResultFolder results(forced);
  results.remove_former();
  results.add_text("found.json", report_text);
  results.finish();
  EXPECT_EQ(test::read_bytes(out("notes.txt")), "mine");
}

TEST_F(ResultFolderTest, NothingIsWrittenThroughALink) {
  write_results();
  const fs::path precious = folder_.write("precious", "mine");
  fs::remove(out("pose.csv"));
  fs::create_symlink(precious, out("pose.csv"));
  expect_refused([&] { ResultFolder results(options()); }, {"pose.csv"});
  ResultFolderOptions forced = options();
  forced.force = true;
  ResultFolder results(forced);
  results.remove_former();
  results.add_text("pose.csv", "pose");
  results.finish();
  EXPECT_EQ(test::read_bytes(precious), "mine");
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
}

TEST_F(ResultFolderTest, APipeIsRefused) {
  write_results();
  fs::remove(out("pose.csv"));
  ASSERT_EQ(mkfifo(out("pose.csv").c_str(), 0600), 0);
  expect_refused([&] { ResultFolder results(options()); }, {"pose.csv"});
}

TEST_F(ResultFolderTest, AnInputStaysUntilItIsMadeAgain) {
  write_results();
  ResultFolder results(options());
  const fs::path inputs[] = {folder_.path() / "nowhere", out() / "." / "pose.csv"};
  results.remove_former(inputs);
  EXPECT_FALSE(fs::exists(out("part_a.stl")));
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
  results.add_text("pose.csv", "another");
  results.finish();
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "another");
}

TEST_F(ResultFolderTest, BelongsToOneCommandAtATime) {
  const ResultFolder results(options());
  expect_refused([&] { ResultFolder other(options()); }, {"another program is writing it"});
}

TEST_F(ResultFolderTest, TakesOverFromAKilledCommand) {
  fs::create_directory(out());
  write(PendingFile::part_of(out("found.json")), "{");
  write(PendingFile::part_of(out("part_a.stl")), "cut");
  write_results();
  EXPECT_FALSE(fs::exists(PendingFile::part_of(out("found.json"))));
}

}  // namespace
}  // namespace penumbra::io
