// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <cstdio>

#include <penumbra/base/text.hpp>

namespace penumbra::detail {
namespace {

constexpr std::string_view white_space = " \t\r\n";
constexpr std::size_t longest_quote = 120;

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(white_space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, longest_quote)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7f ? ' ' : c;
  }
  if (text.size() > longest_quote) out += "...";
  return out + '"';
}

std::string printed(double number) {
  char buffer[32];
  const int length = std::snprintf(buffer, sizeof buffer, "%.6g", number);
  return {buffer, static_cast<std::size_t>(length)};
}

std::string fixed(double number, int places) {
  char buffer[400];  // the largest double has 309 digits before the point
  const auto result =
      std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed, places);
  return {buffer, result.ptr};
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool to_numbers(std::string_view text, std::span<double> out) {
  for (double& number : out) {
    text = trimmed(text);
    const std::string_view word = text.substr(0, text.find_first_of(white_space));
    const auto value = to_number(word);
    if (!value) return false;
    number = *value;
    text.remove_prefix(word.size());
  }
  return trimmed(text).empty();
}

}  // namespace penumbra::detail
