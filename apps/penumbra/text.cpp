// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/text.hpp>
#include <io/files/printable.hpp>

namespace penumbra::app {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

void print_table(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows)
    for (std::string& cell : row) cell = io::without_controls(cell);
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    std::cout << line << '\n';
  }
}

void print_line(const std::string& line) { std::cout << io::without_controls(line) << '\n'; }

void print_error(std::string message, std::string_view from) {
  std::ranges::replace(message, '\n', ' ');
  std::cerr << from << io::without_controls(message) << '\n';
}

void print_notes(std::span<const std::string> notes) {
  for (const std::string& note : notes) print_error("note: " + note);
}

}  // namespace penumbra::app
