// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

Intrinsics::Intrinsics(int width, int height, double fx, double fy, double cx, double cy)
    : width_(width), height_(height), fx_(fx), fy_(fy), cx_(cx), cy_(cy) {
  std::ostringstream what;
  if (width < 1 || height < 1 || width > max_size || height > max_size) {
    what << "camera: image size " << width << " x " << height << " is not within 1 .. " << max_size;
  } else if (std::int64_t{width} * height > max_pixels) {
    what << "camera: image size " << width << " x " << height << " has more than " << max_pixels
         << " pixels";
  } else if (!(fx > 0 && fy > 0 && fx <= max_focal && fy <= max_focal)) {
    what << "camera: focal lengths fx = " << fx << ", fy = " << fy
         << " must be positive numbers of pixels, at most " << max_focal;
  } else if (fx < least_focal * width) {
    what << "camera: focal length fx = " << fx << " of an image " << width
         << " pixels wide: is it a length? expected pixels";
  } else if (!std::isfinite(cx) || !std::isfinite(cy)) {
    what << "camera: principal point cx = " << cx << ", cy = " << cy << " must be finite";
  } else {
    return;
  }
  throw InputError(what.str());
}

Intrinsics Intrinsics::binned(int bx, int by) const {
  if (bx < 1 || by < 1 || bx > width_ || by > height_) {
    std::ostringstream what;
    what << "camera: binning " << bx << " x " << by << " must be at least 1 x 1 and at most the "
         << "image, " << width_ << " x " << height_;
    throw InputError(what.str());
  }
  return {width_ / bx, height_ / by,           fx_ / bx,
          fy_ / by,    (cx_ + 0.5) / bx - 0.5, (cy_ + 0.5) / by - 0.5};
}

Intrinsics Intrinsics::cropped(int x, int y, int width, int height) const {
  // Compared without sums, which could overflow.
  if (x < 0 || y < 0 || width < 1 || height < 1 || width > width_ || height > height_ ||
      x > width_ - width || y > height_ - height) {
    std::ostringstream what;
    what << "camera: region of interest " << width << " x " << height << " at (" << x << ", " << y
         << ") does not lie inside the image, " << width_ << " x " << height_;
    throw InputError(what.str());
  }
  return {width, height, fx_, fy_, cx_ - x, cy_ - y};
}

}  // namespace penumbra
