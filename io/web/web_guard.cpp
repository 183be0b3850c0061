// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <system_error>
#include <utility>

#include <sys/random.h>

#include <io/files/numbers.hpp>
#include <io/web/web_guard.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t token_bytes = 16;

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// Splits "name:port", with IPv6 in brackets. The default port is that of HTTP.
std::pair<std::string, std::string> split_host(std::string_view host) {
  const auto colon = host.rfind(':');
  const auto bracket = host.rfind(']');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && bracket > colon))
    return {lower(host), "80"};
  return {lower(host.substr(0, colon)), std::string(host.substr(colon + 1))};
}

/// Returns whether a name is an IP address: digits and dots, or brackets. DNS cannot resolve such a
/// name.
bool is_ip_literal(const std::string& name) {
  if (name.starts_with('[')) return name.ends_with(']');
  return !name.empty() && std::all_of(name.begin(), name.end(),
                                      [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

bool is_loopback_name(const std::string& name) {
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

/// Returns the cookie's name. Browsers send a host's cookies to all of its ports, so each server
/// has its own name.
std::string cookie_name(std::uint16_t port) { return "penumbra_" + std::to_string(port); }

}  // namespace

WebGuard::WebGuard(WebPlace place, std::string token)
    : place_(std::move(place)), token_(std::move(token)) {}

bool WebGuard::is_own_host(std::string_view host) const {
  const auto [name, port] = split_host(host);
  if (port != std::to_string(place_.port)) return false;
  if (is_loopback_name(name) || name == lower(place_.address) ||
      name == "[" + lower(place_.address) + "]")
    return true;
  if (place_.is_loopback) return false;
  const std::string machine = lower(place_.machine);
  return is_ip_literal(name) || name == machine || name == machine + ".local";
}

std::optional<WebAnswer> WebGuard::refuse(const WebSender& sender) const {
  if (!sender.host) return web_error(400, "a request needs one Host header");
  if (!is_own_host(*sender.host))
    return web_error(403, "this server does not serve under that name; open " +
                              (token_.empty() ? url() : std::string("the address it printed")));
  // Browsers send the origin of every WebSocket and of every request whose answer a foreign page
  // reads.
  if (sender.origin && lower(*sender.origin) != "http://" + lower(*sender.host))
    return web_error(403, "pages of another origin are not served");
  return std::nullopt;
}

bool WebGuard::knows_token(const WebSender& sender) const {
  if (token_.empty()) return true;
  const std::string name = cookie_name(place_.port) + "=";
  std::string_view cookies = sender.cookies;
  bool known = false;
  while (!cookies.empty()) {
    const std::string_view one = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(cookies.size(), one.size() + 1));
    const std::string_view cookie = trimmed(one);
    if (cookie.starts_with(name)) known |= equal_secrets(cookie.substr(name.size()), token_);
  }
  return known;
}

bool WebGuard::brings_token(const WebRequest& request) const {
  const auto given = request.query.find("token");
  return !token_.empty() && given != request.query.end() && equal_secrets(given->second, token_);
}

std::string WebGuard::cookie() const {
  return cookie_name(place_.port) + "=" + token_ + "; HttpOnly; SameSite=Strict; Path=/";
}

std::string WebGuard::url() const {
  std::string host = place_.address;
  if (host == "0.0.0.0" || host == "::") host = place_.machine;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return "http://" + host + ":" + std::to_string(place_.port) + "/" +
         (token_.empty() ? "" : "?token=" + token_);
}

std::string random_token() {
  std::array<unsigned char, token_bytes> bytes{};
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const auto got = getrandom(bytes.data() + filled, bytes.size() - filled, 0);
    if (got < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "no random numbers for a token");
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4U];
    text += "0123456789abcdef"[byte & 15U];
  }
  return text;
}

const std::string& server_id() {
  static const std::string id = random_token();
  return id;
}

bool equal_secrets(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |=
        static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  // Volatile, so that the compiler does not make a comparison that ends early.
  volatile unsigned kept = difference;
  return kept == 0;
}

}  // namespace penumbra::io
