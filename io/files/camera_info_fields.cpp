// SPDX-License-Identifier: Apache-2.0
// By sensor_msgs/msg/CameraInfo.msg, k, p and roi refer to the full resolution, width x height. roi
// is a window of it, and binning makes one pixel of each block of the window.
#include <algorithm>
#include <cmath>

#include <penumbra/base/error.hpp>

#include <io/files/camera_info.hpp>

namespace penumbra::io {
namespace {

/// Runs `call`. An InputError that it throws becomes a fault of the field.
template <typename F>
auto blame(const CameraInfoFields& info, const char* field, const F& call) {
  try {
    return call();
  } catch (const InputError& fault) {
    info.fail(field, fault.what());
    throw;
  }
}

int pixels_of(const CameraInfoFields& info, const char* field, std::int64_t value, int least = 0) {
  if (value < least || value > Intrinsics::max_size)
    info.fail(field, "is " + std::to_string(value) + "; expected " + std::to_string(least) +
                         " to " + std::to_string(Intrinsics::max_size) + " pixels");
  return static_cast<int>(value);
}

/// A matrix of a camera_info, by rows.
struct Matrix {
  const CameraInfoFields& info;
  const char* name;
  const std::vector<double>& values;

  void require_size(std::size_t count) const {
    if (values.size() != count)
      info.fail(name, "has " + std::to_string(values.size()) + " values; expected " +
                          std::to_string(count));
  }
  void require(std::initializer_list<std::size_t> places, double wanted, const char* why) const {
    for (const std::size_t i : places)
      if (values[i] != wanted)
        info.fail(name, "value " + std::to_string(i + 1) + " is " + std::to_string(values[i]) +
                            "; " + why);
  }
};

Intrinsics full_intrinsics(const Matrix& m, double fx, double fy, double cx, double cy) {
  const int width = pixels_of(m.info, "width", m.info.width, 1);
  const int height = pixels_of(m.info, "height", m.info.height, 1);
  return blame(m.info, m.name, [&] { return Intrinsics(width, height, fx, fy, cx, cy); });
}

Intrinsics raw_intrinsics(const CameraInfoFields& info) {
  const Matrix k{info, "k", info.k};
  k.require_size(9);
  k.require({1}, 0, "a skew is not supported and must be 0");
  k.require({3, 6, 7}, 0, "expected [fx 0 cx, 0 fy cy, 0 0 1]");
  k.require({8}, 1, "expected [fx 0 cx, 0 fy cy, 0 0 1]");
  return full_intrinsics(k, info.k[0], info.k[4], info.k[2], info.k[5]);
}

Intrinsics rectified_intrinsics(const CameraInfoFields& info) {
  constexpr double rounding = 1e-9;
  const Matrix r{info, "r", info.r}, p{info, "p", info.p};
  r.require_size(9);
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(info.r[i] - (i % 4 == 0 ? 1 : 0)) > rounding)
      info.fail("r",
                "turns the rectified image against the camera; give the pose of the rectified "
                "image as the camera's pose, and the identity here");
  p.require_size(12);
  p.require({1}, 0, "a skew is not supported and must be 0");
  p.require({3, 7, 11}, 0,
            "the image of a second camera of a stereo pair is not supported; expected 0");
  p.require({4, 8, 9}, 0, "expected [fx 0 cx 0, 0 fy cy 0, 0 0 1 0]");
  p.require({10}, 1, "expected [fx 0 cx 0, 0 fy cy 0, 0 0 1 0]");
  return full_intrinsics(p, info.p[0], info.p[5], info.p[2], info.p[6]);
}

Distortion raw_distortion(const CameraInfoFields& info) {
  blame(info, "distortion_model",
        [&] { static_cast<void>(penumbra::distortion_model(info.distortion_model)); });
  return blame(info, "d", [&] { return Distortion(info.distortion_model, info.d); });
}

Intrinsics windowed(const CameraInfoFields& info, const Intrinsics& full, bool rectified) {
  const int x = pixels_of(info, "roi.x_offset", info.roi.x);
  const int y = pixels_of(info, "roi.y_offset", info.roi.y);
  const int width = pixels_of(info, "roi.width", info.roi.width);
  const int height = pixels_of(info, "roi.height", info.roi.height);
  if (x == 0 && y == 0 && width == 0 && height == 0) return full;
  if (rectified && info.roi.do_rectify)
    info.fail("roi.do_rectify",
              "roi is a window of the raw image; give the window of the rectified image and "
              "do_rectify: false");
  return blame(info, "roi", [&] { return full.cropped(x, y, width, height); });
}

Intrinsics binned(const CameraInfoFields& info, const Intrinsics& window) {
  const int x = std::max(pixels_of(info, "binning_x", info.binning_x), 1);
  const int y = std::max(pixels_of(info, "binning_y", info.binning_y), 1);
  return blame(info, x > 1 ? "binning_x" : "binning_y", [&] { return window.binned(x, y); });
}

}  // namespace

Camera camera_of(const CameraInfoFields& info, bool rectified) {
  const Intrinsics full = rectified ? rectified_intrinsics(info) : raw_intrinsics(info);
  return {.intrinsics = binned(info, windowed(info, full, rectified)),
          .distortion = rectified ? Distortion() : raw_distortion(info),
          .range = {},
          .frame_id = info.frame_id};
}

}  // namespace penumbra::io
