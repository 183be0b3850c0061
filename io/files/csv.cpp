// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <type_traits>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/csv.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

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

CsvLines::CsvLines(std::string_view text, const std::filesystem::path& file)
    : file_(file), rest_(text) {
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
      const std::size_t comma = text.find(',', quoted_end(text));
      cells_.push_back(unquoted(trimmed(text.substr(0, comma))));
      if (comma == std::string_view::npos) return true;
      text = trimmed(text.substr(comma + 1));
    }
  }
  return false;
}

/// Returns the length of a cell's quoted text at the begin; 0: there is none.
std::size_t CsvLines::quoted_end(std::string_view text) const {
  if (!text.starts_with('"')) return 0;
  for (std::size_t at = text.find('"', 1); at != std::string_view::npos; at = text.find('"', at)) {
    if (!text.substr(++at).starts_with('"')) return at;
    ++at;
  }
  throw InputError(file_.string() + ":" + std::to_string(line_) +
                   ": a quote is not closed on its line; a cell may hold no line break");
}

std::string_view CsvLines::unquoted(std::string_view cell) {
  // RFC 4180 has no text behind the quotes: such a cell stays as it is.
  if (!cell.starts_with('"') || quoted_end(cell) != cell.size()) return cell;
  cell = cell.substr(1, cell.size() - 2);
  if (cell.find('"') == std::string_view::npos) return trimmed(cell);
  std::string& copy = copies_.emplace_back(cell);
  for (std::size_t at = copy.find('"'); at != std::string::npos; at = copy.find('"', at + 1))
    copy.erase(at, 1);
  return trimmed(copy);
}

FrameTable::FrameTable(const std::filesystem::path& file)
    : file_(file), text_(read_csv(file)), lines_(text_, file) {
  if (!lines_.next()) throw InputError(file.string() + ": is empty; expected a header frame,...");
  header_ = lines_.cells();
  header_line_ = lines_.line();
  if (header_[0] != "frame")
    throw InputError(header_place() + "the first column is '" + printable(header_[0]) +
                     "'; the header must be frame,... with commas between" +
                     (header_[0].empty() ? " (pandas: to_csv(index=False))" : ""));
  for (auto at = header_.begin(); at != header_.end(); ++at)
    if (std::find(header_.begin(), at, *at) != at)
      throw InputError(header_place() + "column '" + printable(*at) + "' is there twice; keep one");
  while (lines_.next()) {
    const auto frame = parse_number<std::int64_t>(lines_.cells()[0]);
    // Ranges end at the next number, which must be valid too.
    if (!frame || *frame < 0 || *frame == std::numeric_limits<std::int64_t>::max())
      throw InputError(place(lines_.line()) + "'" + printable(lines_.cells()[0]) +
                       "' is no frame number; expected a whole number from 0");
    rows_.push_back({lines_.line(), *frame, lines_.cells()});
  }
}

std::optional<std::size_t> FrameTable::find(std::string_view column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}

std::size_t FrameTable::at(std::string_view column, const std::string& form) const {
  if (const auto found = find(column)) return *found;
  throw InputError(header_place() + "has no column '" + std::string(column) + "'; " + form);
}

std::string FrameTable::place(std::size_t line) const {
  return file_.string() + ":" + std::to_string(line) + ": ";
}

void FrameTable::check_width(const Row& row) const {
  if (row.cells.size() != header_.size())
    throw InputError("has " + std::to_string(row.cells.size()) + " cells; the header has " +
                     std::to_string(header_.size()));
}

template <typename T>
T FrameTable::number(const Row& row, std::size_t column) const {
  const std::string_view text = row.cells[column];
  if (const auto value = parse_number<T>(text)) return *value;
  throw InputError(
      "column '" + printable(header_[column]) + "' " +
      (text.empty() ? "is empty" : "is '" + printable(text) + "'") +
      (std::is_integral_v<T> ? "; expected whole nanoseconds" : "; expected a finite number"));
}
template double FrameTable::number(const Row&, std::size_t) const;
template std::int64_t FrameTable::number(const Row&, std::size_t) const;

}  // namespace penumbra::io
