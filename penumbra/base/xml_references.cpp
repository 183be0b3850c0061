// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/base/xml_references-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};

constexpr std::size_t kLongestShown = 16;  // of what follows an '&', in a message

// XML 1.0, production 2.
bool is_character(std::uint32_t code) {
  return code == 0x9 || code == 0xA || code == 0xD || (code >= 0x20 && code <= 0xD7FF) ||
         (code >= 0xE000 && code <= 0xFFFD) || (code >= 0x10000 && code <= 0x10FFFF);
}

void append_utf8(std::uint32_t code, std::string& out) {
  const auto add = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  const auto add_last = [&](unsigned shift) { add(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) return add(code);
  if (code < 0x800) {
    add(0xC0U | (code >> 6U));
  } else if (code < 0x10000) {
    add(0xE0U | (code >> 12U));
    add_last(6);
  } else {
    add(0xF0U | (code >> 18U));
    add_last(12);
    add_last(6);
  }
  add_last(0);
}

/// The character of "#27" or "#x1B".
std::optional<std::uint32_t> character_of(std::string_view number) {
  const bool is_hex = number.starts_with("#x");
  const std::string_view digits = number.substr(is_hex ? 2 : 1);
  std::uint32_t code = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, code, is_hex ? 16 : 10);
  if (error != std::errc{} || stop != end || !is_character(code)) return std::nullopt;
  return code;
}

/// Appends what "&NAME;" stands for.
void append(std::string_view name, std::string& out) {
  if (name.starts_with('#')) {
    const auto code = character_of(name);
    if (!code)
      throw InputError("is not well-formed XML: " + in_quotes("&" + std::string(name) + ";") +
                       " is no character of XML");
    return append_utf8(*code, out);
  }
  for (const auto& [entity, character] : kEntities) {
    if (entity != name) continue;
    out += character;
    return;
  }
  throw InputError("is not well-formed XML: the entity " +
                   in_quotes("&" + std::string(name) + ";") +
                   " is not defined; XML's own are &amp; &lt; &gt; &quot; and &apos;");
}

}  // namespace

std::string without_references(std::string_view text) {
  std::string out;
  std::size_t begin = 0;
  for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', begin)) {
    out += text.substr(begin, at - begin);
    const std::size_t end = text.find_first_of(std::string_view("; \t\r\n&"), at + 1);
    if (end == std::string_view::npos || text[end] != ';' || end == at + 1)
      throw InputError("is not well-formed XML: " + in_quotes(text.substr(at, kLongestShown)) +
                       " begins no entity; an & itself is written &amp;");
    append(text.substr(at + 1, end - at - 1), out);
    begin = end + 1;
  }
  return out += text.substr(begin);
}

}  // namespace penumbra::detail
