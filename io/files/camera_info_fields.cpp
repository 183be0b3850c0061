// SPDX-License-Identifier: Apache-2.0
// What the values mean is said in ROS's sensor_msgs/msg/CameraInfo.msg: k, p and roi refer to the
// full resolution, width x height; roi is a window of that, and binning makes one pixel of each
// block of the window.
#include <algorithm>
#include <cmath>

#include <io/files/camera_info_fields-inl.hpp>

namespace penumbra::io {
namespace {

int within(const InfoValue<std::int64_t>& pixels, std::int64_t least) {
  if (pixels.value < least || pixels.value > Intrinsics::max_size)
    pixels.place.fail("is " + std::to_string(pixels.value) + "; " + std::to_string(least) + " to " +
                      std::to_string(Intrinsics::max_size) + " pixels are wanted");
  return static_cast<int>(pixels.value);
}

int size_of(const InfoValue<std::int64_t>& pixels) { return within(pixels, 1); }
int pixels_of(const InfoValue<std::int64_t>& pixels) { return within(pixels, 0); }

/// Full resolution: the image that the sensor would give without roi and binning.
Intrinsics raw_intrinsics(const CameraInfoFields& info) {
  const InfoMatrix k = info.k();
  k.require(9);
  k.require(1, 0, "a skew is not supported and must be 0");
  for (const std::size_t i : {3U, 6U, 7U}) k.require(i, 0, "[fx 0 cx, 0 fy cy, 0 0 1] is wanted");
  k.require(8, 1, "[fx 0 cx, 0 fy cy, 0 0 1] is wanted");
  const int width = size_of(info.width());
  const int height = size_of(info.height());
  return k.place.blamed_for([&] {
    return Intrinsics(width, height, k.values[0], k.values[4], k.values[2], k.values[5]);
  });
}

Distortion raw_distortion(const CameraInfoFields& info) {
  const InfoValue<std::string> model = info.distortion_model();
  const std::string& name = model.value;
  model.place.blamed_for([&] { static_cast<void>(penumbra::distortion_model(name)); });
  const InfoMatrix d = info.d();
  return d.place.blamed_for([&] { return Distortion(name, d.values); });
}

void require_identity(const InfoMatrix& r) {
  constexpr double rounding = 1e-9;
  r.require(9);
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(r.values[i] - (i % 4 == 0 ? 1 : 0)) > rounding)
      r.place.fail(
          "turns the rectified image against the camera; give the camera's pose as that of the "
          "rectified image and the identity here");
}

Intrinsics rectified_intrinsics(const CameraInfoFields& info) {
  require_identity(info.r());
  const InfoMatrix p = info.p();
  p.require(12);
  p.require(1, 0, "a skew is not supported and must be 0");
  for (const std::size_t i : {3U, 7U, 11U})
    p.require(i, 0, "the image of a second camera of a stereo pair is not supported; 0 is wanted");
  for (const std::size_t i : {4U, 8U, 9U})
    p.require(i, 0, "[fx 0 cx 0, 0 fy cy 0, 0 0 1 0] is wanted");
  p.require(10, 1, "[fx 0 cx 0, 0 fy cy 0, 0 0 1 0] is wanted");
  const int width = size_of(info.width());
  const int height = size_of(info.height());
  return p.place.blamed_for([&] {
    return Intrinsics(width, height, p.values[0], p.values[5], p.values[2], p.values[6]);
  });
}

/// The window of roi; all of the image where every value is 0.
Intrinsics windowed(const CameraInfoFields& info, const Intrinsics& full, bool rectified) {
  const std::optional<InfoWindow> roi = info.roi();
  if (!roi) return full;
  const int x = pixels_of(roi->x);
  const int y = pixels_of(roi->y);
  const int width = pixels_of(roi->width);
  const int height = pixels_of(roi->height);
  if (x == 0 && y == 0 && width == 0 && height == 0) return full;
  if (rectified && roi->do_rectify.value)
    roi->do_rectify.place.fail(
        "the rectified image's window is not that of roi; give the roi of the rectified image "
        "and do_rectify: false");
  return roi->place.blamed_for([&] { return full.cropped(x, y, width, height); });
}

Intrinsics binned(const CameraInfoFields& info, const Intrinsics& window) {
  const InfoValue<std::int64_t> x = info.binning_x(), y = info.binning_y();
  const int bx = std::max(pixels_of(x), 1);
  const int by = std::max(pixels_of(y), 1);
  if (bx == 1 && by == 1) return window;
  return (bx > 1 ? x : y).place.blamed_for([&] { return window.binned(bx, by); });
}

}  // namespace

void InfoMatrix::require(std::size_t count) const {
  if (values.size() != count)
    place.fail("has " + std::to_string(values.size()) + " values; " + std::to_string(count) +
               " are wanted");
}

void InfoMatrix::require(std::size_t i, double wanted, const std::string& why) const {
  if (values[i] != wanted)
    place.fail("value " + std::to_string(i + 1) + " is " + std::to_string(values[i]) + "; " + why);
}

Camera camera_of(const CameraInfoFields& info, bool rectified) {
  const Intrinsics full = rectified ? rectified_intrinsics(info) : raw_intrinsics(info);
  return {.intrinsics = binned(info, windowed(info, full, rectified)),
          .distortion = rectified ? Distortion() : raw_distortion(info),
          .range = {},
          .frame_id = info.frame_id()};
}

}  // namespace penumbra::io
