// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace penumbra::test {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

Outcome penumbra(const std::vector<std::string>& arguments,
                 const std::vector<std::string>& environment) {
  const TemporaryFolder folder;
  std::string command = "env";
  for (const std::string& variable : environment) command += " " + quoted(variable);
  command += " timeout 600 " + quoted(PENUMBRA_PROGRAM);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command +=
      " </dev/null >" + quoted(folder.path() / "out") + " 2>" + quoted(folder.path() / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder.path() / "out"),
          read_file(folder.path() / "err")};
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

void write_file(const std::filesystem::path& file, const std::string& content) {
  std::ofstream stream(file, std::ios::binary);
  stream << content;
  EXPECT_TRUE(stream.flush()) << file;
}

void edit_file(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string content = read_file(file);
  const std::size_t at = content.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no " << from;
  write_file(file, content.replace(at, from.size(), to));
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace penumbra::test
