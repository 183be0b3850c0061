// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <array>
#include <filesystem>
#include <fstream>

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

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.write("a.npy", "old");
};

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

/// As /dev/stdout is: behind a link of the kernel's, whose text need not be a path.
TEST_F(PendingFileTest, AnOpenPipeIsWrittenToAsItIs) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const fs::path link = folder_.path() / "link.npy";
  fs::create_symlink("/proc/self/fd/" + std::to_string(ends[1]), link);
  PendingFile file(link);
  write(file);
  file.finish();
  std::array<char, 3> text{};
  EXPECT_EQ(read(ends[0], text.data(), 3), 3);
  EXPECT_EQ(std::string(text.data(), 3), "new");
  for (const int end : ends) close(end);
}

}  // namespace
}  // namespace penumbra::io
