// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <io/web/web_types.hpp>

namespace penumbra::io {

/// The headers that identify the sender of a request, as views into the request. Nothing if the
/// header is missing, or if there is more than one Host.
struct WebSender {
  std::optional<std::string_view> host, origin;
  std::string_view cookies;
};

/// The address that a server listens on.
struct WebPlace {
  std::string address;  ///< as given
  std::uint16_t port = 0;
  bool is_loopback = true;
  std::string machine = {};  ///< this machine's name
};

/// Refuses requests that other web pages make a browser send: requests for a foreign name (DNS
/// rebinding) or from a foreign origin. If the server listens on more than the loopback, it also
/// requires a token.
class WebGuard {
 public:
  /// `token`: empty for none.
  WebGuard(WebPlace place, std::string token);

  /// Returns the answer that refuses a request, or nothing if the request is allowed.
  [[nodiscard]] std::optional<WebAnswer> refuse(const WebSender& sender) const;

  /// Returns whether the sender's cookie has the token, or no token is required.
  [[nodiscard]] bool knows_token(const WebSender& sender) const;
  /// Returns whether a request's query has the token.
  [[nodiscard]] bool brings_token(const WebRequest& request) const;
  /// Returns the value of Set-Cookie.
  [[nodiscard]] std::string cookie() const;
  /// Returns the URL for the user.
  [[nodiscard]] std::string url() const;

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;

  WebPlace place_;
  std::string token_;
};

/// Returns 128 random bits in hexadecimal.
[[nodiscard]] std::string random_token();

/// Compares texts in a time that does not depend on where they differ.
[[nodiscard]] bool equal_secrets(std::string_view a, std::string_view b);

}  // namespace penumbra::io
