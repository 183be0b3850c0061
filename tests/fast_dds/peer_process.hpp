// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/child_process.hpp"

#include <array>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <fcntl.h>
#include <poll.h>

namespace penumbra::test {

/// A running fast_dds_peer. It ends with this.
class PeerProcess {
 public:
  explicit PeerProcess(std::vector<std::string> words) {
    words.insert(words.begin(), PENUMBRA_FAST_DDS_PEER);
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
  ~PeerProcess() {
    kill();
    close(out_);
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  /// The next line that it says, if it comes within 120 s.
  [[nodiscard]] std::optional<std::string> line() {
    constexpr int patience_ms = 120'000;
    pollfd ready{out_, POLLIN, 0};
    std::string text;
    for (char c = 0; poll(&ready, 1, patience_ms) > 0 && read(out_, &c, 1) == 1; text += c)
      if (c == '\n') return text;
    return std::nullopt;
  }

  /// Waits until it says so; false: it says something else or nothing.
  [[nodiscard]] bool says(const std::string& text) { return line() == text; }

  /// Lets one that publishes messages of pattern.hpp begin. Who wants the first of them waits until
  /// both sides know of each other.
  void go() { send("\n", 1); }

  /// For one that publishes what it is given.
  void give(std::span<const std::byte> message) {
    const auto size = static_cast<std::uint32_t>(message.size());
    send(&size, sizeof(size));
    send(message.data(), size);
  }

  /// SIGKILL: it says no goodbye.
  void kill() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGKILL);
    static_cast<void>(end());
  }

  /// Closes its stdin, upon which it ends; its exit status.
  int end() {
    if (pid_ < 0) return -1;
    close(in_);
    return wait_for(pid_);
  }

 private:
  void send(const void* bytes, std::size_t size) {
    if (write(in_, bytes, size) != static_cast<ssize_t>(size))
      throw std::runtime_error("it is gone");
  }

  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;  // pipes to its stdin and from its stdout
};

/// A process on a domain. `words`: of fast_dds_peer, from the mode on; publishers are ready.
[[nodiscard]] inline std::unique_ptr<PeerProcess> make_peer(int domain,
                                                            std::vector<std::string> words) {
  const bool publishes = words[0] == "publish" || words[0] == "repeat";
  words.insert(words.begin(), std::to_string(domain));
  auto process = std::make_unique<PeerProcess>(words);
  if (publishes && !process->says("ready")) throw std::runtime_error("a peer is not ready");
  return process;
}

}  // namespace penumbra::test
