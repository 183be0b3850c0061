// SPDX-License-Identifier: Apache-2.0
#include "web_client.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

constexpr int patience_s = 60;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

WebClient::WebClient(std::uint16_t port, int receive_buffer)
    : port_(port), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval limit{patience_s, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  if (receive_buffer > 0)
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0)
    throw std::runtime_error("no connection to port " + std::to_string(port));
}

WebClient::~WebClient() {
  if (socket_ >= 0) ::close(socket_);
}

WebClient::WebClient(WebClient&& other) noexcept
    : port_(other.port_),
      socket_(std::exchange(other.socket_, -1)),
      received_(std::move(other.received_)) {}

bool WebClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void WebClient::finish() { ::shutdown(socket_, SHUT_WR); }

bool WebClient::fill() {
  std::array<char, 65536> buffer{};
  const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
  if (got > 0) received_.append(buffer.data(), static_cast<std::size_t>(got));
  return got > 0;
}

std::optional<std::string> WebClient::take(std::size_t count) {
  while (received_.size() < count)
    if (!fill()) return std::nullopt;
  std::string bytes = received_.substr(0, count);
  received_.erase(0, count);
  return bytes;
}

HttpReply WebClient::get(const std::string& target, const std::string& headers,
                         const std::string& host) {
  const std::string name = host.empty() ? "127.0.0.1:" + std::to_string(port_) : host;
  send("GET " + target + " HTTP/1.1\r\nHost: " + name + "\r\n" + headers + "\r\n");
  return reply();
}

HttpReply WebClient::reply() {
  HttpReply reply;
  std::size_t end = 0;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos)
    if (!fill()) return reply;
  const std::string head = *take(end + 4);
  if (head.rfind("HTTP/1.1 ", 0) != 0) return reply;
  reply.status = std::stoi(head.substr(9, 3));
  for (std::size_t line = head.find("\r\n") + 2; line + 2 < head.size();) {
    const std::size_t next = head.find("\r\n", line);
    const std::size_t colon = head.find(": ", line);
    reply.headers[lower(head.substr(line, colon - line))] =
        head.substr(colon + 2, next - colon - 2);
    line = next + 2;
  }
  const auto length = reply.headers.find("content-length");
  if (length == reply.headers.end()) return reply;
  const auto body = take(std::stoul(length->second));
  if (!body) return {};
  reply.body = *body;
  return reply;
}

HttpReply WebClient::upgrade(const std::string& target, const std::string& headers) {
  return get(target,
             "Upgrade: websocket\r\nConnection: Upgrade\r\n"
             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
                 headers);
}

bool WebClient::send_frame(std::uint8_t opcode, std::string_view payload) {
  std::string frame{static_cast<char>(0x80U | opcode)};
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80U | payload.size());
  } else {
    frame += static_cast<char>(0x80U | 126U);
    frame += static_cast<char>(payload.size() >> 8U);
    frame += static_cast<char>(payload.size() & 255U);
  }
  constexpr std::string_view mask = "mask";
  frame += mask;
  for (std::size_t i = 0; i < payload.size(); ++i)
    frame += static_cast<char>(payload[i] ^ mask[i % mask.size()]);
  return send(frame);
}

std::optional<WebClient::Message> WebClient::message() {
  while (true) {
    const auto head = take(2);
    if (!head) return std::nullopt;
    std::size_t size = static_cast<unsigned char>((*head)[1]);
    if (size >= 126) {
      const auto bytes = take(size == 126 ? 2 : 8);
      if (!bytes) return std::nullopt;
      size = 0;
      for (const char c : *bytes) size = size << 8U | static_cast<unsigned char>(c);
    }
    auto payload = take(size);
    if (!payload) return std::nullopt;
    const auto opcode = static_cast<std::uint8_t>((*head)[0] & 15);
    if (opcode == 9)
      send_frame(10, *payload);
    else
      return Message{opcode, std::move(*payload)};
  }
}

bool WebClient::is_closed() {
  std::array<char, 65536> buffer{};
  while (true) {
    const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
    if (got > 0) continue;
    return got == 0 || errno == ECONNRESET;
  }
}

}  // namespace penumbra::test
