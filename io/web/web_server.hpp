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

  /// Limit for connections that have shown the token, or that sent a request if none is required.
  /// Above it, the connection that was idle the longest is closed.
  std::size_t max_connections = 256;
  /// Limit for connections that have not. Above it, the oldest is closed.
  std::size_t max_unauthenticated = 64;
  /// Limit for the bytes of all answers that wait for their clients. Above it, the oldest answer is
  /// dropped and its connection closed.
  std::size_t max_waiting_bytes = std::size_t{256} << 20U;
  std::chrono::milliseconds request_time{10'000};  ///< time limit to receive a request
  std::chrono::milliseconds answer_time{60'000};   ///< time limit to send its answer
};

/// An HTTP and WebSocket server over TCP. Requests are GET and HEAD, small and without a body.
/// Requests that other pages make a browser send are refused (WebGuard). If the server listens on
/// more than the loopback, it requires a token.
class WebServer {
 public:
  /// Listens and serves. `handler` must outlive this. Throws InputError if the address or port is
  /// not available, or if this build has no server.
  WebServer(const WebOptions& options, WebHandler& handler);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Returns the URL for the user, with the token.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const;

  /// Asks all channels for their next message. Any thread may call this.
  void wake();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io
