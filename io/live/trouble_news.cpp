// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <io/live/trouble_news.hpp>

namespace penumbra::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A message without its numbers.
std::string kind_of(const std::string& message) {
  std::string kind;
  for (std::size_t i = 0; i < message.size(); ++i) {
    const bool in_number = message[i] == '.' && i > 0 && is_digit(message[i - 1]);
    if (!is_digit(message[i]) && !in_number) kind += message[i];
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
