// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/running_program.hpp"
#include "../support/temporary_folder.hpp"
#include "packet.hpp"
#include "web_client.hpp"

#include <chrono>
#include <thread>

namespace penumbra::test {

/// Waits up to 120 s; false: in vain.
template <typename IsSo>
bool eventually(const IsSo& is_so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  for (; !is_so(); std::this_thread::sleep_for(std::chrono::milliseconds(20)))
    if (std::chrono::steady_clock::now() > end) return false;
  return true;
}

/// A running `penumbra view`, or another command that serves its page. It ends with this.
class ViewerProcess {
 public:
  /// Waits up to 120 s until it prints its address or ends. `--port 0` is added.
  explicit ViewerProcess(std::vector<std::string> arguments, const std::string& command = "view");

  [[nodiscard]] std::uint16_t port() const { return port_; }  ///< 0: it did not start
  [[nodiscard]] WebClient client() const { return WebClient(port_); }

  [[nodiscard]] nlohmann::json get_json(const std::string& path) const;
  /// `with`: parts and other options of the query.
  [[nodiscard]] Packet packet(std::size_t frame, const std::string& with) const;
  /// Waits up to 120 s until all frames are judged, then the session.
  [[nodiscard]] nlohmann::json complete_session() const;

  /// SIGINT; its exit status.
  int end() { return program_.end(SIGINT); }

 private:
  TemporaryFolder folder_;
  RunningProgram program_;
  std::uint16_t port_ = 0;
};

}  // namespace penumbra::test
