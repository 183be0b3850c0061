// SPDX-License-Identifier: Apache-2.0
// Reading the numbers of a targets.yaml.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/frame_values.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// Numbers for the columns, or for these and all optional columns.
[[nodiscard]] ValueFormat fixed_format(std::vector<std::string_view> columns,
                                       std::vector<std::string_view> optional_columns = {});

/// x, y, z, qx, qy, qz, qw; and `optional_columns` after them.
[[nodiscard]] ValueFormat pose_format(std::vector<std::string_view> optional_columns = {});

/// Returns the first three numbers, metres.
[[nodiscard]] Eigen::Vector3d position_of(const std::vector<double>& numbers);
/// Returns the pose of the first seven. Throws InputError for a quaternion that is not of length 1.
[[nodiscard]] Eigen::Isometry3d isometry_of(const std::vector<double>& numbers);

/// Returns a number above 0.
[[nodiscard]] double positive(const YamlNode& node);

/// Returns the frame of the key `link`; without it the camera's.
[[nodiscard]] ReferenceFrame link_of(const YamlNode& node, const Robot& robot);

/// Runs `call` and puts `place` before the message of an InputError that it throws.
template <typename F>
auto at_place(const std::string& place, const F& call) {
  try {
    return call();
  } catch (const InputError& fault) {
    throw InputError(place + fault.what());
  }
}

}  // namespace penumbra::io
