// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra::test {

struct HttpReply {
  int status = 0;                              // 0: none came
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

/// A connection to 127.0.0.1 that knows as little of HTTP and WebSocket as it can: what a test
/// sends is what goes out. Reads wait 60 s at most.
class WebClient {
 public:
  /// `receive_buffer`: bytes of the kernel's; 0: its own choice.
  explicit WebClient(std::uint16_t port, int receive_buffer = 0);
  ~WebClient();
  WebClient(WebClient&& other) noexcept;
  WebClient& operator=(WebClient&&) = delete;
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  /// False: the other side has closed.
  bool send(std::string_view bytes);
  /// Says that nothing more is sent.
  void finish();

  /// GET with this Host ("127.0.0.1:PORT" by default) and these header lines.
  HttpReply get(const std::string& target, const std::string& headers = "",
                const std::string& host = "");
  /// What comes of what was sent.
  HttpReply reply();

  /// A WebSocket handshake; the reply's status is 101 where it worked.
  HttpReply upgrade(const std::string& target, const std::string& headers = "");
  /// A frame of a client: masked, and final.
  bool send_frame(std::uint8_t opcode, std::string_view payload);
  bool send_text(std::string_view text) { return send_frame(1, text); }

  struct Message {
    std::uint8_t opcode = 0;
    std::string payload;
  };
  /// The next frame, pings answered; nothing: the connection is closed.
  std::optional<Message> message();

  /// Whether the other side closes within 60 s.
  bool is_closed();

 private:
  bool fill();
  std::optional<std::string> take(std::size_t count);

  std::uint16_t port_;
  int socket_ = -1;
  std::string received_;
};

}  // namespace penumbra::test
