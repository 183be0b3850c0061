// SPDX-License-Identifier: Apache-2.0
#include "peer_process.hpp"

#include "../support/child_process.hpp"

#include <array>
#include <csignal>
#include <cstdint>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>

namespace penumbra::test {

PeerProcess::PeerProcess(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {PENUMBRA_FAST_DDS_PEER};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipes");
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, to[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, from[1], STDOUT_FILENO);
  pid_ = start_process(words, files);
  close(to[0]);
  close(from[1]);
  in_ = to[1];
  out_ = from[0];
}

PeerProcess::~PeerProcess() {
  kill();
  close(out_);
}

std::optional<std::string> PeerProcess::line() {
  constexpr int patience_ms = 120'000;
  pollfd ready{out_, POLLIN, 0};
  std::string text;
  for (char c = 0; poll(&ready, 1, patience_ms) > 0 && read(out_, &c, 1) == 1; text += c)
    if (c == '\n') return text;
  return std::nullopt;
}

void PeerProcess::send(const void* bytes, std::size_t size) {
  if (write(in_, bytes, size) != static_cast<ssize_t>(size)) throw std::runtime_error("it is gone");
}

void PeerProcess::give(std::span<const std::byte> message) {
  const auto size = static_cast<std::uint32_t>(message.size());
  send(&size, sizeof(size));
  send(message.data(), size);
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
  return wait_for(pid_);
}

}  // namespace penumbra::test
