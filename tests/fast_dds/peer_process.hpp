// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra::test {

/// A running fast_dds_peer. It ends with this.
class PeerProcess {
 public:
  explicit PeerProcess(const std::vector<std::string>& arguments);
  ~PeerProcess();
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  /// The next line that it says, if it comes within 120 s.
  [[nodiscard]] std::optional<std::string> line();

  /// Waits until it says so; false: it says something else or nothing.
  [[nodiscard]] bool says(const std::string& text) { return line() == text; }

  /// Lets one that publishes messages of pattern.hpp begin. Who wants the first of them waits until
  /// both sides know of each other.
  void go() { send("\n", 1); }

  /// For one that publishes what it is given.
  void give(std::span<const std::byte> message);

  /// SIGSTOP: it answers nothing.
  void stop();

  /// SIGKILL: it says no goodbye.
  void kill();

  /// Closes its stdin, upon which it ends; its exit status.
  int end();

 private:
  void send(const void* bytes, std::size_t size);

  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;  // pipes to its stdin and from its stdout
};

}  // namespace penumbra::test
