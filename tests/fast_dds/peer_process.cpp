// SPDX-License-Identifier: Apache-2.0
#include "peer_process.hpp"

#include <array>
#include <csignal>
#include <cstdint>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

constexpr int patience_ms = 120'000;

}  // namespace

PeerProcess::PeerProcess(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {PENUMBRA_FAST_DDS_PEER};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipes");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, from[1], STDOUT_FILENO);
  const int fault = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(to[0]);
  close(from[1]);
  in_ = to[1];
  out_ = from[0];
  if (fault != 0) throw std::runtime_error("fast_dds_peer does not start");
}

PeerProcess::~PeerProcess() {
  kill();
  close(out_);
}

bool PeerProcess::read_exactly(void* to, std::size_t size) {
  auto* at = static_cast<char*>(to);
  while (size > 0) {
    pollfd ready{out_, POLLIN, 0};
    if (poll(&ready, 1, patience_ms) <= 0) return false;
    const ssize_t got = read(out_, at, size);
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

std::optional<std::string> PeerProcess::line() {
  std::string text;
  for (char c = 0; read_exactly(&c, 1);) {
    if (c == '\n') return text;
    text += c;
  }
  return std::nullopt;
}

void PeerProcess::go() {
  if (write(in_, "\n", 1) != 1) throw std::runtime_error("it is gone");
}

void PeerProcess::give(std::span<const std::byte> message) {
  const auto size = static_cast<std::uint32_t>(message.size());
  if (write(in_, &size, sizeof(size)) != sizeof(size)) throw std::runtime_error("it is gone");
  for (std::size_t done = 0; done < message.size();) {
    const ssize_t went = write(in_, message.data() + done, message.size() - done);
    if (went <= 0) throw std::runtime_error("it is gone");
    done += static_cast<std::size_t>(went);
  }
}

void PeerProcess::stop() { ::kill(pid_, SIGSTOP); }

void PeerProcess::kill() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  static_cast<void>(end());
}

int PeerProcess::end() {
  if (pid_ < 0) return -1;
  close(in_);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace penumbra::test
