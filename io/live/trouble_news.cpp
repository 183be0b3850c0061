// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include <penumbra/pipeline/frame.hpp>

#include <io/live/trouble_news.hpp>

namespace penumbra::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_sign(char c) { return c == '-' || c == '+'; }

/// Where a number ends that begins at `i`, with its sign and exponent; `i` where none does.
std::size_t number_end(std::string_view text, std::size_t i) {
  const auto digit_at = [&](std::size_t at) { return at < text.size() && is_digit(text[at]); };
  const std::size_t first = i + (is_sign(text[i]) ? 1 : 0);
  if (!digit_at(first)) return i;
  std::size_t end = first;
  while (digit_at(end) || (end < text.size() && text[end] == '.')) ++end;
  if (end >= text.size() || text[end] != 'e') return end;
  std::size_t exponent = end + 1;
  if (exponent < text.size() && is_sign(text[exponent])) ++exponent;
  if (!digit_at(exponent)) return end;
  while (digit_at(exponent)) ++exponent;
  return exponent;
}

/// A message without its numbers. Which joints contradict each other is no kind: of an arm that
/// moves it is now these, now those.
std::string kind_of(std::string_view message) {
  const std::string_view disagree = to_string(FrameStatus::poses_disagree);
  if (message.starts_with(disagree)) return std::string(disagree);
  std::string kind;
  for (std::size_t i = 0; i < message.size();) {
    const std::size_t end = number_end(message, i);
    if (end == i) kind += message[i++];
    i = std::max(i, end);
  }
  return kind;
}

}  // namespace

std::vector<std::string> TroubleNews::look(const DiagnosticArrayMessage& message) {
  std::vector<std::string> lines;
  std::map<std::string, std::string> now;
  for (const DiagnosticStatusMessage& status : message.status) {
    if (status.level == DiagnosticStatusMessage::ok) continue;
    std::string kind = kind_of(status.message);
    const auto told = told_.find(status.name);
    if (told == told_.end() || told->second != kind)
      lines.push_back(status.name + ": " + status.message);
    now[status.name] = std::move(kind);
  }
  for (const auto& [name, kind] : told_)
    if (!now.empty() && !now.contains(name)) lines.push_back(name + ": well again");
  if (now.empty() && !told_.empty()) lines.emplace_back("penumbra: all is judged");
  told_ = std::move(now);
  return lines;
}

}  // namespace penumbra::io
