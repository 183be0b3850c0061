// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view stamp_column = "stamp";
constexpr std::string_view depth_column = "expected_depth";

std::string list_of(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) text += "," + std::string(name);
  return text;
}

}  // namespace

struct ValueTables::Table {
  struct Row {
    std::size_t line = 0;
    std::int64_t frame = 0;
    std::vector<std::string_view> cells;
  };

  std::filesystem::path file;
  std::string text;
  std::size_t header_line = 1;
  std::vector<std::string_view> header;
  std::optional<std::size_t> name_column;
  std::unordered_map<std::string_view, std::vector<Row>> rows;  // by name; "" without names

  [[nodiscard]] std::string place(std::size_t line) const {
    return file.string() + ":" + std::to_string(line) + ": ";
  }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
  }
  void read_header(const CsvLines& lines);
  void add(const CsvLines& lines);
};

void ValueTables::Table::read_header(const CsvLines& lines) {
  header = lines.cells();
  header_line = lines.line();
  if (header[0] != "frame")
    throw InputError(
        place(lines.line()) + "the first column is '" + printable(header[0]) +
        "'; the header must be frame and then, in any order, the others, with commas between");
  for (auto at = header.begin(); at != header.end(); ++at)
    if (std::find(header.begin(), at, *at) != at)
      throw InputError(place(lines.line()) + "column '" + printable(*at) +
                       "' is there twice; keep one");
  name_column = find("name");
}

void ValueTables::Table::add(const CsvLines& lines) {
  Row row{lines.line(), 0, lines.cells()};
  const auto frame = parse_number<std::int64_t>(row.cells[0]);
  if (!frame || *frame < 0)
    throw InputError(place(row.line) + "'" + printable(row.cells[0]) +
                     "' is no frame number; a whole number from 0 is wanted");
  row.frame = *frame;
  if (name_column && *name_column >= row.cells.size())
    throw InputError(place(row.line) + "frame " + std::to_string(*frame) + " has no name");
  const std::string_view name = name_column ? row.cells[*name_column] : std::string_view();
  rows[name].push_back(std::move(row));
}

ValueTables::ValueTables() = default;
ValueTables::~ValueTables() = default;

const ValueTables::Table& ValueTables::read(const std::filesystem::path& file) {
  const auto [entry, is_new] = tables_.try_emplace(file);
  if (!is_new) return *entry->second;
  entry->second = std::make_unique<Table>();
  Table& table = *entry->second;
  table.file = file;
  table.text = read_csv(file);
  CsvLines lines(table.text);
  if (!lines.next()) throw InputError(file.string() + ": is empty; a header frame,... is wanted");
  table.read_header(lines);
  while (lines.next()) table.add(lines);
  return table;
}

namespace {

/// Which columns of a table hold a target's values.
struct ValueColumns {
  std::vector<std::size_t> numbers;
  std::optional<std::size_t> stamp, depth;
};

ValueColumns columns_of(const ValueTables::Table& table, const ValueFormat& format) {
  ValueColumns columns;
  const std::string header = table.place(table.header_line) + "has no column '";
  for (const std::string_view name : format.columns) {
    const auto column = table.find(name);
    if (!column)
      throw InputError(header + std::string(name) +
                       "'; the header must be frame and then, in any order, [name,][stamp]" +
                       list_of(format.columns));
    columns.numbers.push_back(*column);
  }
  for (const std::string_view name : format.optional_columns)
    if (const auto column = table.find(name)) columns.numbers.push_back(*column);
  const std::size_t more = columns.numbers.size() - format.columns.size();
  if (more > 0 && more < format.optional_columns.size())
    throw InputError(table.place(table.header_line) + "has some of the columns" +
                     list_of(format.optional_columns) + "; give all of these or none");
  columns.stamp = table.find(stamp_column);
  columns.depth = table.find(depth_column);
  std::vector<std::string_view> known{"frame", "name", stamp_column, depth_column};
  known.insert(known.end(), format.columns.begin(), format.columns.end());
  known.insert(known.end(), format.optional_columns.begin(), format.optional_columns.end());
  for (const std::string_view name : table.header)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(table.place(table.header_line) + "unknown column '" + printable(name) + "'" +
                       near_names(name, known));
  return columns;
}

template <typename T>
T cell(const ValueTables::Table& table, const ValueTables::Table::Row& row, std::size_t column) {
  const std::string_view text = row.cells[column];
  if (const auto value = parse_number<T>(text)) return *value;
  throw InputError(
      "column '" + printable(table.header[column]) + "' " +
      (text.empty() ? "is empty" : "is '" + printable(text) + "'") +
      (std::is_integral_v<T> ? "; whole nanoseconds are wanted" : "; a finite number is wanted"));
}

FrameValue value_of(const ValueTables::Table& table, const ValueTables::Table::Row& row,
                    const ValueColumns& columns) {
  FrameValue value;
  value.place = table.place(row.line);
  try {
    if (row.cells.size() != table.header.size())
      throw InputError("has " + std::to_string(row.cells.size()) + " cells; the header has " +
                       std::to_string(table.header.size()));
    for (const std::size_t column : columns.numbers)
      value.numbers.push_back(cell<double>(table, row, column));
    if (columns.stamp) value.stamp = cell<std::int64_t>(table, row, *columns.stamp);
    if (columns.depth) value.expected_depth = cell<double>(table, row, *columns.depth);
  } catch (const InputError& fault) {
    value.fault = value.place + fault.what();
  }
  return value;
}

}  // namespace

FrameValues FrameValues::read(const YamlNode& node, const ValueFormat& format,
                              const std::filesystem::path& folder, std::string_view name,
                              ValueTables& tables) {
  FrameValues values;
  if (!node.is_map() || (node.find("frames") == nullptr && node.find("csv") == nullptr)) {
    values.constant_ = Written{node, {}};
    values.constant_->value.numbers = format.read(node);
    return values;
  }
  const bool has_csv = node.find("csv") != nullptr;
  node.allow_only({"frames", "csv"});
  if (has_csv && node.find("frames") != nullptr)
    node.fail("has both frames and csv; one of them is wanted");
  if (has_csv)
    values.read_csv(node.at("csv"), format, folder, name, tables);
  else
    values.read_frames(node.at("frames"), format);
  return values;
}

void FrameValues::read_frames(const YamlNode& frames, const ValueFormat& format) {
  file_ = "targets file";
  for (const YamlNode& entry : frames.entries()) {
    const auto index = parse_number<std::int64_t>(entry.key());
    if (!index || *index < 0) entry.fail("is no frame number; a whole number from 0 is wanted");
    FrameValue value;
    if (entry.is_null())
      value.fault = "not found in frame " + entry.key();
    else
      value.numbers = format.read(entry);
    if (!by_frame_.emplace(*index, value).second)
      entry.fail("frame " + std::to_string(*index) + " is there already; keep one");
    if (!entry.is_null()) written_.push_back({entry, std::move(value)});
  }
}

void FrameValues::read_csv(const YamlNode& node, const ValueFormat& format,
                           const std::filesystem::path& folder, std::string_view name,
                           ValueTables& tables) {
  if (format.columns.empty()) node.fail("values of this kind do not fit a CSV file; use frames");
  const ValueTables::Table& table = tables.read(folder / node.text());
  const ValueColumns columns = columns_of(table, format);
  file_ = table.file.string();
  has_stamps_ = columns.stamp.has_value();
  const auto rows = table.rows.find(table.name_column ? name : std::string_view());
  if (rows == table.rows.end())
    node.fail(file_ + " has no row" +
              (table.name_column ? " of name '" + std::string(name) + "'" : std::string()));
  for (const ValueTables::Table::Row& row : rows->second) {
    const auto [known, is_new] = by_frame_.emplace(row.frame, value_of(table, row, columns));
    if (!is_new)
      throw InputError(table.place(row.line) + "frame " + std::to_string(row.frame) +
                       " is there already; keep one");
  }
}

FrameValue FrameValues::at(std::int64_t index) const {
  if (constant_) return constant_->value;
  const auto found = by_frame_.find(index);
  if (found != by_frame_.end()) return found->second;
  FrameValue none;
  none.fault = "not found in frame " + std::to_string(index) + ": " + file_ + " has none";
  return none;
}

void FrameValues::check_written(const std::function<void(const FrameValue&)>& check) const {
  const auto check_one = [&](const Written& written) {
    written.node.blamed_for([&] { check(written.value); });
  };
  if (constant_) check_one(*constant_);
  for (const Written& written : written_) check_one(written);
}

}  // namespace penumbra::io
