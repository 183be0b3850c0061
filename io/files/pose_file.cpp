// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iomanip>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <Eigen/SVD>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/npy.hpp>
#include <io/files/numbers.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/printable.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

constexpr double max_rotation_error = 1e-4;  // per element; files with few digits are off by less
constexpr double rounding = 1e-14;           // of doubles
constexpr double max_distance = 1e6;         // metres: float32 depths beyond would mean nothing
constexpr std::string_view expected_forms =
    "expected 4 x 4 or 3 x 4 numbers, x y z qx qy qz qw, or YAML of these (easy_handeye)";

/// The numbers of a pose, by rows.
struct PoseNumbers {
  std::vector<double> values;
  std::size_t rows = 0;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file.string() + ": " + what);
}

/// Reads rows of numbers with commas or blanks between, as CSV files and numpy.savetxt have.
PoseNumbers read_rows(std::string text, const std::filesystem::path& file) {
  constexpr std::string_view marks = " \t;[]";
  std::replace_if(
      text.begin(), text.end(), [&](char c) { return marks.find(c) != marks.npos; }, ',');
  PoseNumbers numbers;
  std::size_t width = 0;  // of the first row
  CsvLines lines(text, file);
  while (lines.next()) {
    const std::string place = file.string() + ":" + std::to_string(lines.line()) + ": ";
    const std::size_t before = numbers.values.size();
    if (lines.cells().front().starts_with('#')) continue;
    for (const std::string_view cell : lines.cells()) {
      if (cell.empty()) continue;
      const auto value = parse_number<double>(cell);
      if (!value)
        throw InputError(place + "'" + printable(cell) + "' is no finite number; " +
                         std::string(expected_forms));
      numbers.values.push_back(*value);
    }
    const std::size_t count = numbers.values.size() - before;
    if (count == 0) continue;
    if (numbers.rows == 0) width = count;
    if (count != width || ++numbers.rows > 4)
      throw InputError(place + "has " + std::to_string(count) + " numbers as row " +
                       std::to_string(numbers.rows) + "; " + std::string(expected_forms));
  }
  return numbers;
}

PoseNumbers read_array(const std::string& bytes, const std::filesystem::path& file) {
  NpyHeader header;
  if (const std::string fault = parse_npy_header(std::as_bytes(std::span(bytes)), header);
      !fault.empty())
    fail(file, fault);
  const bool is_double = header.type == "<f8";
  if (header.shape.size() != 2 || header.shape[0] < 3 || header.shape[0] > 4 ||
      header.shape[1] != 4 || (!is_double && header.type != "<f4"))
    fail(file, "holds '" + printable(header.type) + "' in " + std::to_string(header.shape.size()) +
                   " dimensions; expected 4 x 4 or 3 x 4 float32 or float64");
  const std::size_t rows = header.shape[0], size = is_double ? sizeof(double) : sizeof(float);
  if (bytes.size() != header.size + 4 * rows * size)
    fail(file, "is truncated or damaged; expected " + std::to_string(4 * rows) + " numbers");
  PoseNumbers numbers{.values = {}, .rows = rows};
  for (std::size_t i = 0; i < 4 * rows; ++i) {
    const std::size_t at = header.is_fortran ? i % 4 * rows + i / 4 : i;
    float single = 0;
    double value = 0;
    if (is_double)
      std::memcpy(&value, &bytes[header.size + at * size], size);
    else
      std::memcpy(&single, &bytes[header.size + at * size], size);
    numbers.values.push_back(is_double ? value : single);
    if (!std::isfinite(numbers.values.back())) fail(file, "holds a number that is not finite");
  }
  return numbers;
}

/// Returns the numbers x, y, z, qx, qy, qz, qw of a map.
PoseNumbers read_map(const YamlNode& root) {
  const auto one_of = [](const YamlNode& map, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      if (const YamlNode* const found = map.find(name)) return found;
    return static_cast<const YamlNode*>(nullptr);
  };
  const YamlNode* const outer = one_of(root, {"transformation", "transform", "pose"});
  const YamlNode& map = outer != nullptr ? *outer : root;
  if (outer != nullptr && one_of(map, {"pose"}) != nullptr) return read_map(map);
  const YamlNode* const position = one_of(map, {"translation", "position"});
  const YamlNode* const rotation = one_of(map, {"rotation", "orientation"});
  PoseNumbers numbers{.values = {}, .rows = 1};
  const auto add = [&](const YamlNode& from, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) numbers.values.push_back(from.at(name).number());
  };
  if (position != nullptr && rotation != nullptr) {
    add(*position, {"x", "y", "z"});
    add(*rotation, {"x", "y", "z", "w"});
  } else if (map.find("qx") != nullptr) {
    add(map, {"x", "y", "z", "qx", "qy", "qz", "qw"});
  } else {
    map.fail("is no pose; " + std::string(expected_forms));
  }
  return numbers;
}

PoseNumbers read_numbers(const std::filesystem::path& file) {
  constexpr std::uintmax_t most_bytes = 1U << 16U;
  std::error_code ignored;
  if (std::filesystem::file_size(file, ignored) > most_bytes && !ignored)
    fail(file, "is too large for a pose; " + std::string(expected_forms));
  const std::string text = read_csv(file);
  if (text.starts_with("\x93NUMPY")) return read_array(text, file);
  CsvLines lines(text, file);
  while (lines.next()) {
    const char first = lines.cells().front().empty() ? ',' : lines.cells().front().front();
    if (first == '#') continue;
    const bool is_mark = lines.cells().front() == "---";  // of a YAML document
    if (!is_mark && std::string_view("+-.,[0123456789").find(first) != std::string_view::npos)
      break;
    std::vector<YamlNode> documents = YamlNode::parse_all(text, file);
    // ros2 topic echo ends every message with the mark of a next document.
    if (documents.size() > 1 && documents[1].is_null()) documents.resize(1);
    if (documents.size() > 1) documents[1].fail("is a second document (---); keep one");
    const YamlNode& root = documents.front();
    if (!root.is_map()) root.fail("is no pose; " + std::string(expected_forms));
    return read_map(root);
  }
  return read_rows(text, file);
}

Eigen::Isometry3d rigid_pose(const Eigen::Matrix4d& matrix, const std::filesystem::path& file) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    fail(file, "is no rigid transform: its last row must be 0,0,0,1");
  const Eigen::Matrix3d given = matrix.topLeftCorner<3, 3>();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  const double error = (given - nearest).cwiseAbs().maxCoeff();
  if (!(error <= max_rotation_error))
    fail(file, "is no rigid transform: its rotation part is off by " + std::to_string(error) +
                   "; at most 0.0001 is taken for rounding");
  if (nearest.determinant() < 0.0)
    fail(file, "is no rigid transform: it mirrors (determinant -1 instead of 1)");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = error <= rounding ? given : nearest;  // as it was written
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

}  // namespace

Eigen::Isometry3d read_pose_csv(const std::filesystem::path& file) {
  const auto [values, rows] = read_numbers(file);
  const bool is_matrix = values.size() == 12 || values.size() == 16;
  if (!(is_matrix && (rows == 1 || rows * 4 == values.size())) &&
      !(values.size() == 7 && rows == 1))
    fail(file, "has " + std::to_string(values.size()) + " numbers in " + std::to_string(rows) +
                   " rows; " + std::string(expected_forms));
  Eigen::Isometry3d pose;
  if (is_matrix) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (std::size_t i = 0; i < values.size(); ++i)
      matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = values[i];
    pose = rigid_pose(matrix, file);
  } else {
    try {
      pose = isometry_of(values);
    } catch (const InputError& error) {
      fail(file, error.what());
    }
  }
  if (pose.translation().cwiseAbs().maxCoeff() > max_distance)
    fail(file, "is more than 1000 km away; expected metres");
  return pose;
}

void write_pose_csv(const std::filesystem::path& file, const Eigen::Isometry3d& pose) {
  std::ostringstream text;
  text << pose.matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, ",", "\n")) << '\n';
  write_file(file, text.str().data(), text.str().size());
}

std::string static_transform_command(const Eigen::Isometry3d& T_parent_child,
                                     const std::string& parent, const std::string& child) {
  std::ostringstream text;
  const Eigen::Quaterniond q(T_parent_child.linear());
  const Eigen::Vector3d at = T_parent_child.translation();
  text << std::fixed << std::setprecision(5) << "ros2 run tf2_ros static_transform_publisher --x "
       << at.x() << " --y " << at.y() << " --z " << at.z() << std::setprecision(6) << " --qx "
       << q.x() << " --qy " << q.y() << " --qz " << q.z() << " --qw " << q.w() << " --frame-id "
       << for_shell(parent) << " --child-frame-id " << for_shell(child);
  return text.str();
}

}  // namespace penumbra::io
