// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <io/web/web_request.hpp>

namespace penumbra::io {

/// What of a request tells who sends it. Views into the request; nothing: the header is not there,
/// or there is more than one Host.
struct WebSender {
  std::optional<std::string_view> host, origin;
  std::string_view cookies;
};

/// Where a server listens.
struct WebPlace {
  std::string address;  ///< as given
  std::uint16_t port = 0;
  bool is_loopback = true;
  std::string machine = {};  ///< this machine's name
};

/// Refuses what other web pages may make a browser send: requests under a foreign name (DNS
/// rebinding) or from a foreign origin. Bound to more than the loopback it wants a token, too.
class WebGuard {
 public:
  /// `token`: empty for none.
  WebGuard(WebPlace place, std::string token);

  /// Why a request is refused; nothing: it is not.
  [[nodiscard]] std::optional<WebAnswer> refuse(const WebSender& sender) const;

  /// Whether the sender showed the token, in its cookie. True where none is wanted.
  [[nodiscard]] bool knows_token(const WebSender& sender) const;
  /// Whether a request's query holds it.
  [[nodiscard]] bool brings_token(const WebRequest& request) const;
  /// The value of Set-Cookie.
  [[nodiscard]] std::string cookie() const;
  /// What a user opens.
  [[nodiscard]] std::string url() const;

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;

  WebPlace place_;
  std::string token_;
};

/// 128 random bits in hexadecimal.
[[nodiscard]] std::string random_token();

/// Takes the same time wherever the texts differ.
[[nodiscard]] bool equal_secrets(std::string_view a, std::string_view b);

}  // namespace penumbra::io
