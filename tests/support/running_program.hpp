// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "child_process.hpp"

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>

namespace penumbra::test {

/// A command of `penumbra` that runs as long as this lives.
class RunningProgram {
 public:
  /// `log`: takes stdout and stderr.
  RunningProgram(std::vector<std::string> arguments, const std::filesystem::path& log) {
    arguments.insert(arguments.begin(), PENUMBRA_PROGRAM);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT, 0644);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_ = start_process(arguments, files);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() {
    if (pid_ > 0) end();
  }

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool has_ended() const {
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
    return ended.si_pid == pid_;
  }

  /// Ends it by a signal, and returns its exit status.
  int end(int signal = SIGTERM) {
    ::kill(pid_, signal);
    return wait_for(pid_);
  }

 private:
  pid_t pid_ = -1;
};

}  // namespace penumbra::test
