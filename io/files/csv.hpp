// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Returns a file's content for CsvLines. Throws InputError as read_whole_file() does, and for
/// UTF-16.
[[nodiscard]] std::string read_csv(const std::filesystem::path& file);

/// Walks over the lines of a text of comma-separated cells that are not empty. Cells may be in
/// double quotes (RFC 4180), but not hold line breaks; spaces around cells, a byte order mark and
/// carriage returns are dropped.
class CsvLines {
 public:
  /// Keeps a view of `text`. `file`: for messages.
  CsvLines(std::string_view text, const std::filesystem::path& file);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  /// Goes to the next line that is not empty; false at the end. Throws InputError for a quote that
  /// is not closed on its line.
  bool next();

  [[nodiscard]] std::size_t line() const { return line_; }  ///< from 1
  /// The cells of this line; their texts live as long as `text` and this object.
  [[nodiscard]] const std::vector<std::string_view>& cells() const { return cells_; }

 private:
  std::size_t quoted_end(std::string_view text) const;
  std::string_view unquoted(std::string_view cell);

  std::filesystem::path file_;
  std::string_view rest_;
  std::deque<std::string> copies_;  // of cells with doubled quotes
  std::size_t line_ = 0;
  std::vector<std::string_view> cells_;
};

/// A CSV file with a header "frame,..." of different names, and rows that begin with the number of
/// a frame.
class FrameTable {
 public:
  struct Row {
    std::size_t line = 0;    ///< from 1
    std::int64_t frame = 0;  ///< at least 0, less than the largest number
    std::vector<std::string_view> cells;
  };

  /// Throws InputError that names file and line for another header or frame number.
  explicit FrameTable(const std::filesystem::path& file);
  FrameTable(const FrameTable&) = delete;
  FrameTable& operator=(const FrameTable&) = delete;

  [[nodiscard]] const std::vector<std::string_view>& header() const { return header_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;

  /// Throws InputError unless there is such a column. `form`: what the header must be.
  [[nodiscard]] std::size_t at(std::string_view column, const std::string& form) const;

  /// Returns "FILE:LINE: ".
  [[nodiscard]] std::string place(std::size_t line) const;
  [[nodiscard]] std::string header_place() const { return place(header_line_); }

  /// Throws InputError, without the place, unless the row has as many cells as the header.
  void check_width(const Row& row) const;

  /// Returns the number in a cell: double or std::int64_t. Throws InputError, without the place, if
  /// there is none.
  template <typename T>
  [[nodiscard]] T number(const Row& row, std::size_t column) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  CsvLines lines_;
  std::size_t header_line_ = 0;
  std::vector<std::string_view> header_;
  std::vector<Row> rows_;
};

}  // namespace penumbra::io
