// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <io/files/names.hpp>
#include <io/files/target_values-inl.hpp>

namespace penumbra::io {
namespace {

constexpr double quaternion_error = 0.01;  // of its length: rounding in a file, not a wrong value

}  // namespace

ValueFormat fixed_format(std::vector<std::string_view> columns,
                         std::vector<std::string_view> optional_columns) {
  const std::size_t least = columns.size(), most = least + optional_columns.size();
  return {[=](const YamlNode& node) {
            std::vector<double> numbers = node.numbers();
            if (numbers.size() != least && numbers.size() != most) {
              std::string wanted;
              for (const std::string_view column : columns)
                wanted += (wanted.empty() ? "" : ", ") + std::string(column);
              node.fail("has " + std::to_string(numbers.size()) + " values; [" + wanted +
                        "] is wanted");
            }
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
                     "; x, y, z, w of length 1 are wanted");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = position_of(n);
  return pose;
}

double positive(const YamlNode& node) {
  const double value = node.number();
  if (value > 0.0) return value;
  node.fail("is " + node.text() + "; a number above 0 is wanted");
}

ReferenceFrame link_of(const YamlNode& node, const Robot& robot) {
  const YamlNode* link = node.find("link");
  if (link == nullptr) return {};
  if (const auto index = robot.find_link(link->text()))
    return ReferenceFrame::of_link(robot.links()[*index]);
  const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
  link->fail("'" + link->text() + "' is no link of the robot" + near_names(link->text(), known));
}

}  // namespace penumbra::io
