// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include <penumbra/pipeline/frame.hpp>

#include <io/live/diagnostic_changes.hpp>

namespace penumbra::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_sign(char c) { return c == '-' || c == '+'; }

/// Returns the end of the number that begins at `i`, with its sign and exponent, or `i` if no
/// number begins there.
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

/// Returns a message without its numbers. Joints that contradict each other all give the same kind,
/// because the joints change while an arm moves.
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

std::vector<std::string> DiagnosticChanges::update(const DiagnosticArrayMessage& message) {
  std::vector<std::string> lines;
  std::map<std::string, std::string> now;
  for (const DiagnosticStatusMessage& status : message.status) {
    if (status.level == DiagnosticStatusMessage::ok) continue;
    std::string kind = kind_of(status.message);
    const auto found = reported_.find(status.name);
    if (found == reported_.end() || found->second != kind)
      lines.push_back(status.name + ": " + status.message);
    now[status.name] = std::move(kind);
  }
  for (const auto& [name, kind] : reported_)
    if (!now.empty() && !now.contains(name)) lines.push_back(name + ": recovered");
  if (now.empty() && !reported_.empty()) lines.emplace_back("penumbra: no faults");
  reported_ = std::move(now);
  return lines;
}

}  // namespace penumbra::io
