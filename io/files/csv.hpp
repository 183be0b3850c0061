// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Returns a file's content for CsvLines. Throws InputError as read_whole_file() does, and for
/// UTF-16.
[[nodiscard]] std::string read_csv(const std::filesystem::path& file);

/// Walks over the lines of a text of comma-separated cells that are not empty. Quotes have no
/// meaning; spaces around cells, a byte order mark and carriage returns are dropped.
class CsvLines {
 public:
  /// Keeps a view of `text`.
  explicit CsvLines(std::string_view text);

  /// Goes to the next line that is not empty; false at the end.
  bool next();

  [[nodiscard]] std::size_t line() const { return line_; }  ///< from 1
  [[nodiscard]] const std::vector<std::string_view>& cells() const { return cells_; }

 private:
  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<std::string_view> cells_;
};

}  // namespace penumbra::io
