// SPDX-License-Identifier: Apache-2.0
#include "../support/temporary_folder.hpp"
#include "../support/test.hpp"

#include <penumbra/base/whole_file-inl.hpp>

namespace penumbra::test {
namespace {

TEST(WholeFile, IsReadUpToItsLimit) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("a", std::string("x\0\r\ny", 5));
  EXPECT_EQ(read_whole_file(file, 5), std::string("x\0\r\ny", 5));
  EXPECT_THROW((void)read_whole_file(file, 4), InputError);
  EXPECT_EQ(read_whole_file(folder.write("empty", ""), 0), "");
  // Reading it to its end would wait for ever.
  EXPECT_EQ(read_whole_file("/proc/self/status", FileLimit::text), "");
}

TEST(WholeFile, WhatIsNoneOrTooLargeIsNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path sparse = folder.write("sparse", "");
  const std::uintmax_t size = std::uintmax_t{50} << 30U;
  std::filesystem::resize_file(sparse, size);
  const std::tuple<std::filesystem::path, std::string, std::string> cases[] = {
      {sparse, std::to_string(size), std::to_string(FileLimit::text)},
      {folder.path() / "none", "No such file", ""},
      {folder.path(), "is a folder", ""},
      {"/dev/zero", "not a regular file", ""}};
  for (const auto& [file, why, limit] : cases)
    expect_refused([&f = file] { (void)read_whole_file(f, FileLimit::text); },
                   {file.string() + ": ", why, limit});
}

}  // namespace
}  // namespace penumbra::test
