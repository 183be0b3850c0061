// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>

namespace penumbra::io {

/// The fields of sensor_msgs/CameraInfo. Fields that the wanted camera does not need may be empty.
struct CameraInfoFields {
  /// The window of the images in the full resolution; all 0: the whole image.
  struct Window {
    std::int64_t x = 0, y = 0, width = 0, height = 0;
    bool do_rectify = false;
  };

  std::int64_t width = 0, height = 0;
  std::string distortion_model = {};
  std::vector<double> d = {}, k = {}, r = {}, p = {};
  std::int64_t binning_x = 0, binning_y = 0;  ///< 0 is 1
  Window roi = {};
  std::string frame_id = {};

  /// Throws InputError that names the place of a field ("k", "roi.width").
  std::function<void(const std::string& field, const std::string& what)> fail = {};
};

/// Returns the camera of the images as they come (read_camera_info).
[[nodiscard]] Camera camera_of(const CameraInfoFields& info, bool rectified);

/// Reads a camera's intrinsics from YAML or JSON: a dump of sensor_msgs/CameraInfo (keys k, d, r, p
/// or K, D, R, P; several documents must all be of the same camera), the file that
/// camera_calibration or OpenCV writes (camera_matrix, distortion_coefficients, ...), kalibr's
/// camchain of one camera, or RealSense's fx, fy, ppx, ppy, model and coeffs.
///
/// `rectified`: the images are free of distortion already. Then p is used without distortion, and r
/// must be the identity. Otherwise k and d are used. binning and roi are applied, so that the
/// camera fits the images as they come. Without p, k is used for images without distortion. Throws
/// InputError that names file, line and key.
[[nodiscard]] Camera read_camera_info(const std::filesystem::path& file, bool rectified);

/// The same from text; `file` is for messages.
[[nodiscard]] Camera parse_camera_info(const std::string& text, const std::filesystem::path& file,
                                       bool rectified);

}  // namespace penumbra::io
