// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <string_view>
#include <unordered_map>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// Ranges end at the next number, which must be valid too.
constexpr std::int64_t largest_frame = std::numeric_limits<std::int64_t>::max() - 1;

// The columns of the file.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::optional<std::size_t>> variables;  // per column; none: not a variable
  bool has_stamp = false;
};

bool is_mimic(const Robot& robot, std::string_view name) {
  return std::any_of(robot.joints().begin(), robot.joints().end(),
                     [&](const Joint& joint) { return joint.mimics && joint.name == name; });
}

void check_known(const Robot& robot, std::string_view name, const std::string& place) {
  if (robot.find_variable(name) || is_mimic(robot, name)) return;
  const std::vector<std::string_view> known(robot.variables().begin(), robot.variables().end());
  throw InputError(place + "column '" + printable(name) + "' is no joint of the robot that moves" +
                   near_names(name, known));
}

Columns read_header(const std::vector<std::string_view>& cells, const Robot& robot,
                    const std::string& place) {
  if (cells[0] != "frame")
    throw InputError(place + "the first column is '" + printable(cells[0]) +
                     "'; the header must be frame,[stamp,]JOINT,... with commas between");
  Columns columns{{cells.begin(), cells.end()}, {}, cells.size() > 1 && cells[1] == "stamp"};
  columns.variables.resize(cells.size());
  for (std::size_t i = columns.has_stamp ? 2 : 1; i < cells.size(); ++i) {
    check_known(robot, cells[i], place);
    if (std::find(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(i), cells[i]) !=
        cells.begin() + static_cast<std::ptrdiff_t>(i))
      throw InputError(place + "column '" + printable(cells[i]) + "' is there twice; keep one");
    columns.variables[i] = robot.find_variable(cells[i]);
  }
  for (std::size_t v = 0; v < robot.variables().size(); ++v)
    if (std::find(columns.variables.begin(), columns.variables.end(), std::optional(v)) ==
        columns.variables.end())
      throw InputError(place + "has no column for joint '" + robot.variables()[v] +
                       "'; every joint of the robot that moves must have one");
  return columns;
}

/// A negative stamp shows that the column is something else.
void check_stamp(const Columns& columns, const std::vector<std::string_view>& cells,
                 const std::string& place) {
  if (!columns.has_stamp || cells.size() < 2) return;
  const auto stamp = parse_number<std::int64_t>(cells[1]);
  if (stamp && *stamp < 0)
    throw InputError(place + "stamp " + printable(cells[1]) +
                     " is negative; nanoseconds from 0 are wanted");
}

// Fills stamp and positions from the cells. Returns what is wrong, or nothing.
std::string read_values(const Columns& columns, const std::vector<std::string_view>& cells,
                        JointRow& row) {
  if (cells.size() != columns.names.size())
    return "has " + std::to_string(cells.size()) + " cells; the header has " +
           std::to_string(columns.names.size());
  if (columns.has_stamp) {
    row.stamp = parse_number<std::int64_t>(cells[1]);
    if (!row.stamp) return "stamp '" + printable(cells[1]) + "' is no whole number of nanoseconds";
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!columns.variables[i]) continue;
    const auto value = parse_number<double>(cells[i]);
    if (!value)
      return "column '" + columns.names[i] + "' " +
             (cells[i].empty() ? "is empty"
                               : "is '" + printable(cells[i]) + "', which is no finite number");
    row.positions[*columns.variables[i]] = *value;
  }
  return {};
}

}  // namespace

std::vector<JointRow> read_joint_file(const std::filesystem::path& file, const Robot& robot) {
  const std::string text = read_csv(file);
  const auto place = [&](std::size_t line) {
    return file.string() + ":" + std::to_string(line) + ": ";
  };
  CsvLines lines(text);
  if (!lines.next())
    throw InputError(file.string() + ": is empty; a header frame,[stamp,]JOINT,... is wanted");
  const Columns columns = read_header(lines.cells(), robot, place(lines.line()));

  std::vector<JointRow> rows;
  std::unordered_map<std::int64_t, std::size_t> line_of_frame;
  while (lines.next()) {
    JointRow row;
    const auto index = parse_number<std::int64_t>(lines.cells()[0]);
    if (!index || *index < 0)
      throw InputError(place(lines.line()) + "'" + printable(lines.cells()[0]) +
                       "' is no frame number; a whole number from 0 is wanted");
    if (*index > largest_frame)
      throw InputError(place(lines.line()) + "frame number " + std::to_string(*index) +
                       " is too large; at most " + std::to_string(largest_frame) + " is wanted");
    row.index = *index;
    const auto [first, is_new] = line_of_frame.emplace(row.index, lines.line());
    if (!is_new)
      throw InputError(place(lines.line()) + "frame " + std::to_string(row.index) +
                       " is there already, in line " + std::to_string(first->second));
    check_stamp(columns, lines.cells(), place(lines.line()));
    row.positions.resize(robot.variables().size());
    const std::string fault = read_values(columns, lines.cells(), row);
    if (!fault.empty()) {
      row.fault = place(lines.line()) + "frame " + std::to_string(row.index) + ": " + fault;
      row.positions.clear();
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file.string() + ": has no frames below its header");
  return rows;
}

}  // namespace penumbra::io
