// SPDX-License-Identifier: Apache-2.0
#include "../support/temporary_folder.hpp"
#include "files.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <io/files/pending_file.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

class PendingFileTest : public testing::Test {
 protected:
  static void write(const PendingFile& file) { std::ofstream(file.part()) << "new"; }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.write("a.npy", "old");
};

TEST_F(PendingFileTest, TakesThePlaceOnlyWhenItIsFinished) {
  PendingFile pending(file_);
  write(pending);
  EXPECT_EQ(test::read_bytes(file_), "old") << "as SIGKILL would leave it";
  pending.finish();
  EXPECT_EQ(test::read_bytes(file_), "new");
  EXPECT_EQ(files(), 1U);
}

TEST_F(PendingFileTest, LeavesNothingUnfinished) {
  write(PendingFile(file_));
  {
    const PendingFile pending(file_);
    write(pending);
  }
  EXPECT_EQ(test::read_bytes(file_), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(PendingFileTest, ReplacesWhatALinkLeadsTo) {
  fs::create_symlink("a.npy", folder_.path() / "b.npy");
  fs::create_symlink(folder_.path() / "b.npy", folder_.path() / "c.npy");
  PendingFile pending(folder_.path() / "c.npy");
  write(pending);
  pending.finish();
  EXPECT_EQ(test::read_bytes(file_), "new");
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "b.npy"));
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "c.npy"));

  fs::create_symlink("not_yet.npy", folder_.path() / "d.npy");
  PendingFile first(folder_.path() / "d.npy");
  write(first);
  first.finish();
  EXPECT_EQ(test::read_bytes(folder_.path() / "not_yet.npy"), "new");
}

TEST_F(PendingFileTest, APartThatIsALinkIsNotFollowed) {
  const fs::path other = folder_.write("other", "the user's own");
  const fs::path part = PendingFile::part_of(file_);
  fs::create_symlink(other, part);
  PendingFile pending(file_);
  write(pending);
  pending.finish();
  EXPECT_EQ(test::read_bytes(other), "the user's own");
  EXPECT_EQ(test::read_bytes(file_), "new");
}

TEST_F(PendingFileTest, DevicesAreWrittenToAsTheyAre) {
  PendingFile pending("/dev/null");
  EXPECT_EQ(pending.part(), "/dev/null");
  pending.finish();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// As /dev/stdout is: behind a link of the kernel's, whose text need not be a path.
class OpenFile : public PendingFileTest {
 protected:
  PendingFile pending(int descriptor) const {
    const fs::path link = folder_.path() / "link.npy";
    fs::remove(link);
    fs::create_symlink("/proc/self/fd/" + std::to_string(descriptor), link);
    return PendingFile(link);
  }
};

TEST_F(OpenFile, ThatIsAPipeIsWrittenToAsItIs) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  PendingFile file = pending(ends[1]);
  write(file);
  file.finish();
  std::array<char, 3> text{};
  EXPECT_EQ(read(ends[0], text.data(), 3), 3);
  EXPECT_EQ(std::string(text.data(), 3), "new");
  for (const int end : ends) close(end);
}

/// What is written to the descriptor meanwhile, as to stdout, must not get into the file.
TEST_F(OpenFile, ThatHasANameIsReplaced) {
  const int descriptor = open(file_.c_str(), O_WRONLY);
  PendingFile file = pending(descriptor);
  write(file);
  EXPECT_EQ(::write(descriptor, "a line", 6), 6);
  file.finish();
  EXPECT_EQ(test::read_bytes(file_), "new");
  close(descriptor);
}

TEST_F(OpenFile, ThatWasRemovedIsWrittenToAsItIs) {
  const int descriptor = open(file_.c_str(), O_RDWR);
  fs::remove(file_);
  PendingFile file = pending(descriptor);
  write(file);
  file.finish();
  std::array<char, 3> text{};
  EXPECT_EQ(pread(descriptor, text.data(), 3, 0), 3);
  EXPECT_EQ(std::string(text.data(), 3), "new");
  EXPECT_EQ(files(), 1U) << "the link";
  close(descriptor);
}

TEST_F(PendingFileTest, SaysWhereThePlaceCannotBeTaken) {
  PendingFile pending(folder_.path() / "late");
  write(pending);
  fs::create_directory(folder_.path() / "late");
  EXPECT_HAS(test::input_error([&] { pending.finish(); }), "late: cannot be replaced: ");
}

TEST_F(PendingFileTest, HasOneWriter) {
  PendingFile first(file_);
  write(first);
  EXPECT_HAS(test::input_error([&] { PendingFile second(file_); }),
             file_.string() + ": another program is writing it");
  EXPECT_EQ(test::read_bytes(first.part()), "new") << "untouched";
  first.finish();
  PendingFile second(file_);
  std::ofstream(second.part()) << "newer";
  EXPECT_EQ(test::read_bytes(file_), "new");
  second.finish();
  EXPECT_EQ(test::read_bytes(file_), "newer");
}

TEST_F(PendingFileTest, TakesOverThePartOfAKilledProgram) {
  const fs::path part = folder_.write(PendingFile::part_of("a.npy"), "half");
  {
    const PendingFile pending(file_);
    EXPECT_EQ(pending.part(), part);
  }
  EXPECT_EQ(files(), 1U);
}

TEST_F(PendingFileTest, AFolderHasOneWriter) {
  const FileLock lock(folder_.path());
  EXPECT_HAS(test::input_error([&] { FileLock second(folder_.path()); }),
             folder_.path().string() + ": another program is writing it");
}

TEST_F(PendingFileTest, SaysWhatBecameOfFiles) {
  const FormerFiles former({file_, folder_.path() / "none", "/dev/null", folder_.path() / "b"});
  EXPECT_EQ(former.state(), "; " + file_.string() + " is left as it was");
  fs::remove(file_);
  const fs::path made = folder_.write("b", "new");
  EXPECT_EQ(former.state(), "; " + made.string() + " is new and whole");
  EXPECT_HAS(test::input_error([&] { check_is_no_folder("-o", folder_.path()); }), " is a folder");
}

}  // namespace
}  // namespace penumbra::io
