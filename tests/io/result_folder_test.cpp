// SPDX-License-Identifier: Apache-2.0
// Folders and files that commands write their results into. tests/apps/output_folders_test.cpp
// disturbs those of all commands.
#include "files.hpp"

#include <unistd.h>

#include <io/files/pending_file.hpp>
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

  test::TemporaryFolder folder_;
};

TEST_F(ResultFolderTest, AnEmptyFolderOfItsOwnGoes) {
  { const ResultFolder results(options()); }
  EXPECT_FALSE(fs::exists(out()));
  fs::create_directory(out());
  { const ResultFolder results(options()); }
  EXPECT_TRUE(fs::exists(out())) << "the user's";
}

TEST_F(ResultFolderTest, AnInputStaysUntilItIsMadeAgain) {
  {
    ResultFolder former(options());
    former.begin();
    former.add_text("part_a.stl", "a");
    former.add_text("pose.csv", "pose");
    former.add_text("found.json", json_begin);
    former.finish();
  }
  ResultFolder results(options());
  const fs::path inputs[] = {folder_.path() / "nowhere", out() / "." / "pose.csv"};
  results.begin(inputs);
  EXPECT_FALSE(fs::exists(out("part_a.stl")));
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "pose");
  results.add_text("pose.csv", "another");
  results.finish();
  EXPECT_EQ(test::read_bytes(out("pose.csv")), "another");
}

class PendingFileTest : public testing::Test {
 protected:
  static void write_new(const fs::path& to) {
    PendingFile file(to);
    std::ofstream(file.part()) << "new";
    file.finish();
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.write("a.npy", "old");
};

TEST_F(PendingFileTest, ReplacesWhatALinkLeadsTo) {
  fs::create_symlink("a.npy", folder_.path() / "b.npy");
  fs::create_symlink(folder_.path() / "b.npy", folder_.path() / "c.npy");
  write_new(folder_.path() / "c.npy");
  EXPECT_EQ(test::read_bytes(file_), "new");
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "b.npy"));
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "c.npy"));

  fs::create_symlink("not_yet.npy", folder_.path() / "d.npy");
  write_new(folder_.path() / "d.npy");
  EXPECT_EQ(test::read_bytes(folder_.path() / "not_yet.npy"), "new");
}

/// As /dev/stdout is: behind a link of the kernel's, whose text need not be a path.
TEST_F(PendingFileTest, AnOpenPipeIsWrittenToAsItIs) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const fs::path link = folder_.path() / "link.npy";
  fs::create_symlink("/proc/self/fd/" + std::to_string(ends[1]), link);
  write_new(link);
  std::array<char, 3> text{};
  EXPECT_EQ(read(ends[0], text.data(), 3), 3);
  EXPECT_EQ(std::string(text.data(), 3), "new");
  for (const int end : ends) close(end);
}

}  // namespace
}  // namespace penumbra::io
