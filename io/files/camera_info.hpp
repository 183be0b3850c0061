// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <penumbra/camera/camera.hpp>

namespace penumbra::io {

/// Reads a ROS camera_info YAML file: a dump of sensor_msgs/CameraInfo (keys k, d, r, p or K, D, R,
/// P; several documents must all be of the same camera) or the file that camera_calibration writes
/// (camera_matrix, distortion_coefficients, ...).
///
/// `rectified`: the images are free of distortion already. Then p is used without distortion, and r
/// must be the identity. Otherwise k and d are used. binning and roi are applied, so that the
/// camera fits the images as they come. Throws InputError that names file, line and key.
[[nodiscard]] Camera read_camera_info(const std::filesystem::path& file, bool rectified);

/// The same from text; `file` is for messages.
[[nodiscard]] Camera parse_camera_info(const std::string& text, const std::filesystem::path& file,
                                       bool rectified);

}  // namespace penumbra::io
