// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/base/error.hpp>

#include <io/files/camera_info.hpp>
#include <io/ros/camera_info_message.hpp>

namespace penumbra::io {

Camera camera_of(const CameraInfoMessage& info, const std::string& source, bool rectified) {
  CameraInfoFields fields{.width = info.width,
                          .height = info.height,
                          .distortion_model = info.distortion_model,
                          .d = info.d,
                          .k = {info.k.begin(), info.k.end()},
                          .r = {info.r.begin(), info.r.end()},
                          .p = {info.p.begin(), info.p.end()},
                          .binning_x = info.binning_x,
                          .binning_y = info.binning_y,
                          .roi = {info.roi.x_offset, info.roi.y_offset, info.roi.width,
                                  info.roi.height, info.roi.do_rectify},
                          .frame_id = info.header.frame_id,
                          .fail = [&](const std::string& field, const std::string& what) {
                            throw InputError(source + ": " + field + ": " + what);
                          }};
  const auto require_finite = [&](const char* name, const std::vector<double>& values) {
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
      fields.fail(name, "has a value that is no finite number");
  };
  require_finite(rectified ? "r" : "k", rectified ? fields.r : fields.k);
  require_finite(rectified ? "p" : "d", rectified ? fields.p : fields.d);
  return camera_of(fields, rectified);
}

}  // namespace penumbra::io
