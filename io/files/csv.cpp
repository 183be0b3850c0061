// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/csv.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {

std::string read_csv(const std::filesystem::path& file) {
  std::string text = read_whole_file(file, FileLimit::data);
  // With a byte order mark, or in its place a first letter of which one byte is 0.
  const bool is_utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
                        (text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0'));
  if (is_utf16)
    throw InputError(file.string() + ": is UTF-16, two bytes for a letter; save it as UTF-8");
  return text;
}

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
