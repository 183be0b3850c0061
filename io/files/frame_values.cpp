// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr double quaternion_error = 0.01;  // of its length: rounding in a file, not a wrong value
constexpr std::string_view name_column = "name";
constexpr std::string_view stamp_column = "stamp";
constexpr std::string_view depth_column = "expected_depth";

std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

/// The columns of a table that hold a target's values.
struct ValueColumns {
  std::vector<std::size_t> numbers;
  std::optional<std::size_t> name, stamp, depth;
};

ValueColumns columns_of(const FrameTable& table, const ValueFormat& format) {
  ValueColumns columns{
      {}, table.find(name_column), table.find(stamp_column), table.find(depth_column)};
  for (const std::string_view name : format.columns)
    columns.numbers.push_back(
        table.at(name, "the header must be frame and then, in any order, [name,][stamp,]" +
                           joined(format.columns)));
  for (const std::string_view name : format.optional_columns)
    if (const auto column = table.find(name)) columns.numbers.push_back(*column);
  const std::size_t more = columns.numbers.size() - format.columns.size();
  if (more > 0 && more < format.optional_columns.size())
    throw InputError(table.header_place() + "has some of the columns " +
                     joined(format.optional_columns) + "; give all of these or none");
  std::vector<std::string_view> known{"frame", name_column, stamp_column, depth_column};
  known.insert(known.end(), format.columns.begin(), format.columns.end());
  known.insert(known.end(), format.optional_columns.begin(), format.optional_columns.end());
  for (const std::string_view name : table.header())
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(table.header_place() + "unknown column '" + printable(name) + "'" +
                       near_names(name, known));
  return columns;
}

FrameValue value_of(const FrameTable& table, const FrameTable::Row& row,
                    const ValueColumns& columns) {
  FrameValue value;
  value.place = table.place(row.line);
  try {
    table.check_width(row);
    for (const std::size_t column : columns.numbers)
      value.numbers.push_back(table.number<double>(row, column));
    if (columns.stamp) value.stamp = table.number<std::int64_t>(row, *columns.stamp);
    if (columns.depth) value.expected_depth = table.number<double>(row, *columns.depth);
  } catch (const InputError& fault) {
    value.fault = value.place + fault.what();
  }
  return value;
}

}  // namespace

ValueFormat fixed_format(std::vector<std::string_view> columns,
                         std::vector<std::string_view> optional_columns) {
  const std::size_t least = columns.size(), most = least + optional_columns.size();
  return {[=](const YamlNode& node) {
            std::vector<double> numbers = node.numbers();
            if (numbers.size() != least && numbers.size() != most)
              node.fail("has " + std::to_string(numbers.size()) + " values; expected [" +
                        joined(columns) + "]");
            return numbers;
          },
          std::move(columns), std::move(optional_columns)};
}

ValueFormat pose_format(std::vector<std::string_view> optional_columns) {
  return fixed_format({"x", "y", "z", "qx", "qy", "qz", "qw"}, std::move(optional_columns));
}

Eigen::Vector3d position_of(const std::vector<double>& n) { return {n[0], n[1], n[2]}; }

Eigen::Isometry3d isometry_of(const std::vector<double>& n) {
  Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (!(std::abs(q.norm() - 1.0) <= quaternion_error))
    throw InputError("quaternion has the length " + std::to_string(q.norm()) +
                     "; expected x, y, z, w of length 1");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = position_of(n);
  return pose;
}

FrameValues::FrameValues(const YamlNode& node, const ValueFormat& format, const Check& check,
                         const std::filesystem::path& folder, std::string_view name,
                         ValueTables& tables) {
  const YamlNode* frames = node.is_map() ? node.find("frames") : nullptr;
  const YamlNode* csv = node.is_map() ? node.find("csv") : nullptr;
  if (frames == nullptr && csv == nullptr) {
    constant_.emplace().numbers = format.read(node);
    node.with_context([&] { check(*constant_); });
    return;
  }
  node.allow_only({"frames", "csv"});
  if (frames != nullptr && csv != nullptr)
    node.fail("has both frames and csv; expected one of them");
  if (frames != nullptr) {
    read_frames(*frames, format, check);
    return;
  }
  if (format.columns.empty()) csv->fail("values of this kind do not fit a CSV file; use frames");
  const std::filesystem::path file = folder / csv->text();
  file_ = file.string();
  read_table(tables.try_emplace(file, file).first->second, format, name, *csv);
}

void FrameValues::read_frames(const YamlNode& frames, const ValueFormat& format,
                              const Check& check) {
  for (const YamlNode& entry : frames.entries()) {
    const auto index = parse_number<std::int64_t>(entry.key());
    if (!index || *index < 0) entry.fail("is no frame number; expected a whole number from 0");
    const auto [added, is_new] = by_frame_.try_emplace(*index);
    if (!is_new) entry.fail("frame " + std::to_string(*index) + " is there already; keep one");
    FrameValue& value = added->second;
    if (entry.is_null()) {
      value.fault = "not found in frame " + entry.key();
    } else {
      value.numbers = format.read(entry);
      entry.with_context([&] { check(value); });
    }
  }
}

void FrameValues::read_table(const FrameTable& table, const ValueFormat& format,
                             std::string_view name, const YamlNode& node) {
  const ValueColumns columns = columns_of(table, format);
  has_stamps_ = columns.stamp.has_value();
  for (const FrameTable::Row& row : table.rows()) {
    if (columns.name && *columns.name >= row.cells.size())
      throw InputError(table.place(row.line) + "frame " + std::to_string(row.frame) +
                       " has no name");
    if (columns.name && row.cells[*columns.name] != name) continue;
    if (!by_frame_.emplace(row.frame, value_of(table, row, columns)).second)
      throw InputError(table.place(row.line) + "frame " + std::to_string(row.frame) +
                       " is there already; keep one");
  }
  if (by_frame_.empty())
    node.fail(file_ + " has no row" + (columns.name ? " of name '" + std::string(name) + "'" : ""));
}

FrameValue FrameValues::at(std::int64_t index) const {
  if (constant_) return *constant_;
  const auto found = by_frame_.find(index);
  if (found != by_frame_.end()) return found->second;
  FrameValue none;
  none.fault = "not found in frame " + std::to_string(index) + ": " + file_ + " has none";
  return none;
}

}  // namespace penumbra::io
