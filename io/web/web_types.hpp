// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Bytes that several answers can share.
using SharedBytes = std::shared_ptr<const std::string>;

[[nodiscard]] inline SharedBytes shared_bytes(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

/// A GET or HEAD request.
struct WebRequest {
  std::string path;                          ///< decoded, starts with '/'
  std::map<std::string, std::string> query;  ///< decoded; the last value of each name
};

struct WebAnswer {
  int status = 200;
  std::string type = "application/json";
  std::vector<SharedBytes> body;  ///< sent one after another
  bool keeps = false;  ///< the content of this path never changes, so browsers may cache it
};

/// Returns the answer {"error": "one line"}.
[[nodiscard]] WebAnswer web_error(int status, std::string_view line);

/// Parses path and query of a request's target ("/api/x?with=a%2Cb"). Returns nothing if it is
/// invalid: no '/' at its start, '%' without two digits, or control characters, also encoded ones.
[[nodiscard]] std::optional<WebRequest> parse_target(std::string_view target);

/// Returns an identifier of this process. A page uses it to detect that its data comes from another
/// server on the same port.
[[nodiscard]] const std::string& server_id();

/// A WebSocket client. Any thread calls its members, one at a time.
class WebChannel {
 public:
  WebChannel() = default;
  WebChannel(const WebChannel&) = delete;
  WebChannel& operator=(const WebChannel&) = delete;
  virtual ~WebChannel() = default;

  /// Takes a text from the client. Returns false if it is invalid; then the connection is closed.
  [[nodiscard]] virtual bool take(std::string_view text) = 0;

  /// Returns the parts of the message to send now, or nothing if there is none yet. Called after
  /// take(), after WebServer::wake() and after the last message was sent.
  [[nodiscard]] virtual std::optional<std::vector<SharedBytes>> next() = 0;
};

/// The content of a server. Several threads call it at the same time.
class WebHandler {
 public:
  WebHandler() = default;
  WebHandler(const WebHandler&) = delete;
  WebHandler& operator=(const WebHandler&) = delete;
  virtual ~WebHandler() = default;

  [[nodiscard]] virtual WebAnswer answer(const WebRequest& request) = 0;

  /// Opens a channel for a WebSocket handshake. Returns null if there is no channel with this path.
  [[nodiscard]] virtual std::unique_ptr<WebChannel> open_channel(const std::string& path) = 0;
};

}  // namespace penumbra::io
