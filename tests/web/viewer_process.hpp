// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packet.hpp"
#include "web_client.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace penumbra::test {

/// A running `penumbra view`, or another command that serves its page. It ends with this.
class ViewerProcess {
 public:
  /// Waits up to 120 s until it prints its address. `--port 0` is added.
  explicit ViewerProcess(std::vector<std::string> arguments, const std::string& command = "view");
  ~ViewerProcess();
  ViewerProcess(const ViewerProcess&) = delete;
  ViewerProcess& operator=(const ViewerProcess&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }  ///< 0: it did not start
  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] WebClient client() const { return WebClient(port_); }

  [[nodiscard]] nlohmann::json get_json(const std::string& path) const;
  /// Waits up to 120 s until all frames are judged, then the session.
  [[nodiscard]] nlohmann::json complete_session() const;

  /// SIGINT; its exit status.
  int end();

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  std::string url_;
  std::uint16_t port_ = 0;
};

}  // namespace penumbra::test
