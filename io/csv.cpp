// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/csv.hpp>
#include <io/numbers.hpp>

namespace penumbra::io {

CsvLines::CsvLines(std::string_view text) : rest_(text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool CsvLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (text.empty()) continue;
    cells_.clear();
    for (;;) {
      const std::size_t comma = text.find(',');
      cells_.push_back(trimmed(text.substr(0, comma)));
      if (comma == std::string_view::npos) return true;
      text.remove_prefix(comma + 1);
    }
  }
  return false;
}

}  // namespace penumbra::io
