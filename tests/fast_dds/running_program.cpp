// SPDX-License-Identifier: Apache-2.0
#include "running_program.hpp"

#include <fstream>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {

RunningProgram::RunningProgram(std::vector<std::string> arguments,
                               const std::filesystem::path& log) {
  arguments.insert(arguments.begin(), PENUMBRA_PROGRAM);
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!log.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT,
                                     0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  }
  const int fault = posix_spawn(&pid_, PENUMBRA_PROGRAM, &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (fault != 0) throw std::runtime_error("penumbra does not start");
}

ProcessUsage RunningProgram::usage() const {
  const std::string process = std::to_string(pid_);
  ProcessUsage usage{.when = std::chrono::steady_clock::now(), .memory = memory_of(process)};
  std::ifstream stat("/proc/" + process + "/stat");
  std::string word;
  while (stat >> word && !word.ends_with(')')) continue;
  for (int field = 3; field < 14; ++field) stat >> word;  // proc(5)
  double user = 0, system = 0;
  stat >> user >> system;
  usage.cpu_seconds = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return usage;
}

int RunningProgram::end(int signal) {
  if (pid_ <= 0) return status_;
  ::kill(pid_, signal);
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace penumbra::test
