// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <unordered_map>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

void check_known(const Robot& robot, const FrameTable& table, std::string_view name) {
  const auto& joints = robot.joints();
  const bool needs_none = std::any_of(joints.begin(), joints.end(), [&](const Joint& joint) {
    return (joint.mimics || joint.is_held) && joint.name == name;
  });
  if (needs_none || robot.find_variable(name) || name == "stamp") return;
  const std::vector<std::string_view> known(robot.variables().begin(), robot.variables().end());
  throw InputError(table.header_place() + "column '" + printable(name) +
                   "' is no joint of the robot that moves" + near_names(name, known) +
                   "; leave out columns of other devices");
}

}  // namespace

std::vector<JointRow> read_joint_file(const std::filesystem::path& file, const Robot& robot) {
  const FrameTable table(file);
  for (std::size_t i = 1; i < table.header().size(); ++i)
    check_known(robot, table, table.header()[i]);
  std::vector<std::size_t> columns;  // of each variable
  for (const std::string& variable : robot.variables())
    columns.push_back(table.at(variable,
                               "every joint of the robot that moves must have one, or a position "
                               "in recording.yaml (robot: joints: {NAME: VALUE})"));
  const auto stamp = table.find("stamp");

  std::vector<JointRow> rows;
  std::unordered_map<std::int64_t, std::size_t> line_of_frame;
  for (const FrameTable::Row& from : table.rows()) {
    JointRow& row = rows.emplace_back();
    row.index = from.frame;
    const std::string frame = table.place(from.line) + "frame " + std::to_string(row.index);
    const auto [first, is_new] = line_of_frame.emplace(row.index, from.line);
    if (!is_new)
      throw InputError(frame + " is there already, in line " + std::to_string(first->second));
    try {
      table.check_width(from);
      if (stamp) row.stamp = table.number<std::int64_t>(from, *stamp);
      row.positions = robot.rest_positions();
      for (std::size_t i = 0; i < columns.size(); ++i) try {
          row.positions[i] = table.number<double>(from, columns[i]);
        } catch (const InputError& fault) {
          if (row.fault.empty()) row.fault = frame + ": " + fault.what();
          row.unknown.push_back(i);
        }
    } catch (const InputError& fault) {
      row.fault = frame + ": " + fault.what();
      row.positions.clear();
    }
    if (row.stamp.value_or(0) < 0)  // the column is something else
      throw InputError(table.place(from.line) + "stamp " + std::to_string(*row.stamp) +
                       " is negative; expected nanoseconds from 0");
  }
  if (rows.empty()) throw InputError(file.string() + ": has no frames below its header");
  return rows;
}

FrameStamps read_frame_stamps(const std::filesystem::path& file) {
  const FrameTable table(file);
  FrameStamps stamps;
  const auto column = table.find("stamp");
  for (const FrameTable::Row& row : table.rows())
    if (column && *column < row.cells.size())
      if (const auto stamp = parse_number<std::int64_t>(row.cells[*column]); stamp && *stamp >= 0)
        stamps.emplace(row.frame, *stamp);
  return stamps;
}

}  // namespace penumbra::io
