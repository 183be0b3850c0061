// SPDX-License-Identifier: Apache-2.0
// The scripts of tests/reference, run by Node.js in a folder of the build tree.
#pragma once

#include "temporary_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

namespace penumbra::test {

struct ScriptResult {
  int status = -1;
  std::string output;
  std::string errors;
};

inline std::filesystem::path node_folder() { return PENUMBRA_NODE_FOLDER; }

/// Copies a file unless it exists. The copy is atomic for other processes.
inline void put_whole(const std::filesystem::path& from, const std::filesystem::path& to) {
  namespace fs = std::filesystem;
  if (fs::exists(to) && read_bytes(from) == read_bytes(to)) return;
  const fs::path part = to.string() + ".part";
  fs::copy_file(from, part, fs::copy_options::overwrite_existing);
  fs::rename(part, to);
}

/// Installs the scripts and the npm packages of the lock file into node_folder(). Tests run in
/// parallel: the first one installs, the others wait. Returns whether the installation succeeded.
inline bool node_scripts_are_there() {
  namespace fs = std::filesystem;
  const fs::path source = fs::path(PENUMBRA_SOURCE_DIR) / "tests" / "reference";
  fs::create_directories(node_folder());
  const int lock = ::open((node_folder() / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0 || ::flock(lock, LOCK_EX) != 0) return false;
  for (const auto& entry : fs::directory_iterator(source))
    if (entry.is_regular_file()) put_whole(entry.path(), node_folder() / entry.path().filename());
  const std::string wanted = read_bytes(source / "package-lock.json");
  const fs::path mark = node_folder() / "installed.json";  // the lock file of what is there
  if (!fs::exists(mark) || read_bytes(mark) != wanted) {
    const std::string install =
        "cd '" + node_folder().string() +
        "' && timeout 120 npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1";
    if (std::system(install.c_str()) == 0)
      fs::copy_file(source / "package-lock.json", mark, fs::copy_options::overwrite_existing);
  }
  const bool there = fs::exists(mark) && read_bytes(mark) == wanted;
  ::close(lock);
  return there;
}

/// `arguments`: quoted for the shell.
inline ScriptResult run_script(const std::string& script, const std::string& arguments) {
  const TemporaryFolder folder;
  const auto output = folder.path() / "output", errors = folder.path() / "errors";
  const std::string command = "node '" + (node_folder() / script).string() + "' " + arguments +
                              " >'" + output.string() + "' 2>'" + errors.string() + "'";
  const int status = std::system(command.c_str());
  return {status, read_bytes(output), read_bytes(errors)};
}

}  // namespace penumbra::test

/// Skips the running test where Node.js or its packages are not available.
#define PENUMBRA_REQUIRE_NODE_SCRIPTS()                                               \
  if (!penumbra::test::node_scripts_are_there())                                      \
  GTEST_SKIP() << "skipped: no Node.js with npm, or no npm packages; see npm.log in " \
               << penumbra::test::node_folder()
