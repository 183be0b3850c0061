// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <io/files/json.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

constexpr unsigned char first_printable = 0x20;
constexpr unsigned char del = 0x7F;

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> decode(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    int code = static_cast<unsigned char>(text[i]);
    if (text[i] == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = digit_of(text[i + 1]), low = digit_of(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      code = 16 * high + low;
      i += 2;
    }
    if (code < first_printable || code == del) return std::nullopt;
    decoded += static_cast<char>(code);
  }
  return decoded;
}

bool add_query(std::string_view text, std::map<std::string, std::string>& query) {
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    if (pair.empty()) continue;
    const auto equals = pair.find('=');
    const auto name = decode(pair.substr(0, equals));
    const auto value =
        equals == std::string_view::npos ? std::string() : decode(pair.substr(equals + 1));
    if (!name || !value) return false;
    query[*name] = *value;
  }
  return true;
}

}  // namespace

WebAnswer web_error(int status, std::string_view line) {
  const Json json{{"error", line}};
  return {.status = status, .body = {shared_bytes(json_text(json) + "\n")}};
}

std::optional<WebRequest> parse_target(std::string_view target) {
  const auto question = target.find('?');
  const auto path = decode(target.substr(0, question));
  if (!path || !path->starts_with('/')) return std::nullopt;
  WebRequest request{.path = *path, .query = {}};
  if (question != std::string_view::npos && !add_query(target.substr(question + 1), request.query))
    return std::nullopt;
  return request;
}

}  // namespace penumbra::io
