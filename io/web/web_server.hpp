// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <io/web/web_types.hpp>

namespace penumbra::io {

struct WebOptions {
  std::string address = "127.0.0.1";  ///< an IP address or "localhost"
  std::uint16_t port = 0;             ///< 0: any that is free
  std::uint16_t last_port = 0;        ///< if `port` is in use, the next one up to this is taken
  int threads = 2;

  /// Connections that have shown the token (or asked for something, where none is wanted). For more
  /// of them the one that was idle for longest is closed.
  std::size_t max_connections = 256;
  /// Connections that have not. For more of them the oldest is closed.
  std::size_t max_strangers = 64;
  /// Bytes of answers that wait for their clients, all together; for more of them the oldest is
  /// given up, and its connection closed.
  std::size_t max_waiting_bytes = std::size_t{256} << 20U;
  std::chrono::milliseconds request_time{10'000};  ///< a request must be there in this time
  std::chrono::milliseconds answer_time{60'000};   ///< and its answer be taken in this one
};

/// HTTP and WebSocket over TCP. Requests are small and have no body: GET and HEAD. What a browser
/// would be made to send by other pages is refused (WebGuard); bound to more than the loopback, it
/// wants a token.
class WebServer {
 public:
  /// Listens and serves. `handler` must outlive this. Throws InputError where the address or the
  /// port cannot be had, or this build has no server.
  WebServer(const WebOptions& options, WebHandler& handler);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// What a user opens, with the token.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const;

  /// Channels may have something to send. By any thread.
  void wake();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io
