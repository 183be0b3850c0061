// SPDX-License-Identifier: Apache-2.0
#include "../support/temporary_folder.hpp"
#include "../support/test.hpp"

#include <penumbra/base/whole_file-inl.hpp>

namespace penumbra::test {
namespace {

class WholeFile : public testing::Test {
 protected:
  static void expect_refused(const std::filesystem::path& file, const std::string& why) {
    const std::string message = message_of([&] { (void)read_whole_file(file, FileLimit::text); });
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_TRUE(holds(message, why));
  }

  TemporaryFolder folder_;
};

TEST_F(WholeFile, IsReadUpToItsLimit) {
  const std::filesystem::path file = folder_.write("a", std::string("x\0\r\ny", 5));
  EXPECT_EQ(read_whole_file(file, 5), std::string("x\0\r\ny", 5));
  EXPECT_THROW((void)read_whole_file(file, 4), InputError);
  EXPECT_EQ(read_whole_file(folder_.write("empty", ""), 0), "");
}

TEST_F(WholeFile, AboveItsLimitIsNamedWithBoth) {
  const std::filesystem::path file = folder_.write("sparse", "");
  std::filesystem::resize_file(file, std::uintmax_t{50} << 30U);
  expect_refused(file, std::to_string(std::uintmax_t{50} << 30U));
  expect_refused(file, std::to_string(FileLimit::text));
}

TEST_F(WholeFile, WhatIsNoFileIsNamed) {
  expect_refused(folder_.path() / "none", "No such file");
  expect_refused(folder_.path(), "is a folder");
  expect_refused("/dev/zero", "not a regular file");
}

/// Reading it to its end would wait for ever.
TEST_F(WholeFile, OfTheKernelHasNoContent) {
  EXPECT_EQ(read_whole_file("/proc/self/status", FileLimit::text), "");
}

}  // namespace
}  // namespace penumbra::test
