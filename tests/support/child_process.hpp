// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {

/// Starts a program: its path and its arguments. Destroys `files`.
inline pid_t start_process(std::vector<std::string> words, posix_spawn_file_actions_t& files) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t process = -1;
  const int fault = posix_spawn(&process, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (fault != 0) throw std::runtime_error(words[0] + " does not start");
  return process;
}

/// Waits for its end and sets it to -1. Returns its exit status, or -1 if a signal ended it.
inline int wait_for(pid_t& process) {
  int status = 0;
  waitpid(std::exchange(process, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace penumbra::test
