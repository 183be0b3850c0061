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

/// Bytes that several answers may share.
using SharedBytes = std::shared_ptr<const std::string>;

[[nodiscard]] inline SharedBytes shared_bytes(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

/// What was asked for: only GET and HEAD come so far.
struct WebRequest {
  std::string path;                          ///< decoded, starts with '/'
  std::map<std::string, std::string> query;  ///< decoded; of doubled names the last
};

struct WebAnswer {
  int status = 200;
  std::string type = "application/json";
  std::vector<SharedBytes> body;  ///< sent one behind another
  bool keeps = false;             ///< never changes under its path: a browser may keep it
};

/// {"error": "one line"}.
[[nodiscard]] WebAnswer web_error(int status, std::string_view line);

/// One WebSocket client. Its members are called one at a time, by any thread.
class WebChannel {
 public:
  WebChannel() = default;
  WebChannel(const WebChannel&) = delete;
  WebChannel& operator=(const WebChannel&) = delete;
  virtual ~WebChannel() = default;

  /// A text from the client. False: it is not understood, and the connection is closed.
  [[nodiscard]] virtual bool take(std::string_view text) = 0;

  /// The message to send now, sent one behind another; nothing: there is none yet. Asked for after
  /// take(), after WebServer::wake() and when the last message has gone.
  [[nodiscard]] virtual std::optional<std::vector<SharedBytes>> next() = 0;
};

/// What a server serves. Called by several threads at a time.
class WebHandler {
 public:
  WebHandler() = default;
  WebHandler(const WebHandler&) = delete;
  WebHandler& operator=(const WebHandler&) = delete;
  virtual ~WebHandler() = default;

  [[nodiscard]] virtual WebAnswer answer(const WebRequest& request) = 0;

  /// Of a WebSocket handshake; null: there is no channel of this path.
  [[nodiscard]] virtual std::unique_ptr<WebChannel> open_channel(const std::string& path) = 0;
};

}  // namespace penumbra::io
