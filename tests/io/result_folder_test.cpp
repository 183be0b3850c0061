// SPDX-License-Identifier: Apache-2.0
// The folder that a command writes its results into. tests/apps/output_folders_test.cpp disturbs
// those of all commands.
#include "../support/errors.hpp"
#include "files.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <io/files/result_folder.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

class ResultFolderTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  [[nodiscard]] fs::path out(const char* name) const { return out() / name; }
  [[nodiscard]] ResultFolderOptions options() const {
    return {.path = out(),
            .report = {"found.json", json_begin},
            .others = {{"pose.csv"}, {"part_*.stl"}}};
  }
  /// As a command that succeeds.
  void write_results() const {
    ResultFolder results(options());
    results.begin();
    results.add_text("part_a.stl", "a");
    results.add_text("pose.csv", "pose");
    results.add_text("found.json", json_begin);
    results.finish();
  }

  test::TemporaryFolder folder_;
};

TEST_F(ResultFolderTest, AnEmptyFolderOfItsOwnGoes) {
  { const ResultFolder results(options()); }
  EXPECT_FALSE(fs::exists(out()));
  fs::create_directory(out());
  { const ResultFolder results(options()); }
  EXPECT_TRUE(fs::exists(out())) << "the user's";
}

TEST_F(ResultFolderTest, APipeIsRefused) {
  write_results();
  fs::remove(out("pose.csv"));
  ASSERT_EQ(mkfifo(out("pose.csv").c_str(), 0600), 0);
  test::expect_refused([&] { ResultFolder results(options()); }, {"pose.csv"});
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

}  // namespace
}  // namespace penumbra::io
