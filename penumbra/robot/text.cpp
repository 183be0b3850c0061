// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <cstdio>

#include <penumbra/robot/text-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::size_t kLongestQuote = 120;

}  // namespace

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, kLongestQuote)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7f ? ' ' : c;
  }
  if (text.size() > kLongestQuote) out += "...";
  return out + '"';
}

std::string printed(double number) {
  char buffer[32];
  const int length = std::snprintf(buffer, sizeof buffer, "%.6g", number);
  return {buffer, static_cast<std::size_t>(length)};
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool to_numbers(std::string_view text, std::span<double> out) {
  std::size_t count = 0;
  for (std::size_t begin = text.find_first_not_of(kSpace); begin != std::string_view::npos;) {
    const std::size_t end = text.find_first_of(kSpace, begin);
    const auto value = to_number(text.substr(begin, end - begin));
    if (!value || count == out.size()) return false;
    out[count++] = *value;
    begin = text.find_first_not_of(kSpace, end);
  }
  return count == out.size();
}

}  // namespace penumbra::detail
