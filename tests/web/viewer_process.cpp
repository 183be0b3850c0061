// SPDX-License-Identifier: Apache-2.0
#include "viewer_process.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

constexpr int patience_ms = 120'000;

[[noreturn]] void become_viewer(std::vector<std::string>& arguments, int out) {
  ::dup2(out, STDOUT_FILENO);
  ::signal(SIGINT, SIG_DFL);
  std::vector<char*> texts;
  texts.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) texts.push_back(argument.data());
  texts.push_back(nullptr);
  ::execv(texts.front(), texts.data());
  ::_exit(127);
}

/// Returns what comes from `start` to the end of its line, or nothing if no line has it.
std::string line_from(int descriptor, const std::string& start) {
  std::string text;
  std::array<char, 4096> buffer{};
  while (true) {
    const std::size_t at = text.find(start);
    const std::size_t end = text.find('\n', at);
    if (at != std::string::npos && end != std::string::npos) return text.substr(at, end - at);
    pollfd ready{descriptor, POLLIN, 0};
    if (::poll(&ready, 1, patience_ms) <= 0) return {};
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got <= 0) return {};
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

ViewerProcess::ViewerProcess(std::vector<std::string> arguments, const std::string& command) {
  arguments.insert(arguments.begin(), {PENUMBRA_PROGRAM, command});
  arguments.insert(arguments.end(), {"--port", "0"});
  std::array<int, 2> pipe{};
  EXPECT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  pid_ = ::fork();
  if (pid_ == 0) become_viewer(arguments, pipe[1]);
  ::close(pipe[1]);
  out_ = pipe[0];
  url_ = line_from(out_, "http://");
  const auto colon = url_.rfind(':');
  if (colon != std::string::npos)
    port_ = static_cast<std::uint16_t>(std::stoi(url_.substr(colon + 1)));
}

ViewerProcess::~ViewerProcess() {
  if (pid_ > 0) end();
  ::close(out_);
}

int ViewerProcess::end() {
  ::kill(pid_, SIGINT);
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

nlohmann::json ViewerProcess::get_json(const std::string& path) const {
  const HttpReply reply = client().get(path);
  EXPECT_EQ(reply.status, 200) << path << ": " << reply.body;
  return nlohmann::json::parse(reply.body);
}

nlohmann::json ViewerProcess::complete_session() const {
  constexpr auto step = std::chrono::milliseconds(20);
  nlohmann::json session = get_json("/api/session");
  for (int waited = 0; session["complete"] == false && waited < patience_ms; waited += 20) {
    std::this_thread::sleep_for(step);
    session = get_json("/api/session");
  }
  EXPECT_EQ(session["complete"], true);
  return session;
}

}  // namespace penumbra::test
