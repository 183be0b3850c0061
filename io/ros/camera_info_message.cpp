// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>

#include <io/files/camera_info_fields-inl.hpp>
#include <io/ros/camera_info_message.hpp>

namespace penumbra::io {
namespace {

class InfoOfMessage final : public CameraInfoFields {
 public:
  InfoOfMessage(const CameraInfoMessage& info, const std::string& source)
      : info_(info), source_(source) {}

  [[nodiscard]] InfoValue<std::int64_t> width() const override {
    return {place("width"), info_.width};
  }
  [[nodiscard]] InfoValue<std::int64_t> height() const override {
    return {place("height"), info_.height};
  }
  [[nodiscard]] InfoValue<std::string> distortion_model() const override {
    return {place("distortion_model"), info_.distortion_model};
  }
  [[nodiscard]] InfoMatrix k() const override { return matrix("k", info_.k); }
  [[nodiscard]] InfoMatrix d() const override { return matrix("d", info_.d); }
  [[nodiscard]] InfoMatrix r() const override { return matrix("r", info_.r); }
  [[nodiscard]] InfoMatrix p() const override { return matrix("p", info_.p); }
  [[nodiscard]] InfoValue<std::int64_t> binning_x() const override {
    return {place("binning_x"), info_.binning_x};
  }
  [[nodiscard]] InfoValue<std::int64_t> binning_y() const override {
    return {place("binning_y"), info_.binning_y};
  }
  [[nodiscard]] std::optional<InfoWindow> roi() const override {
    const RegionOfInterest& roi = info_.roi;
    return InfoWindow{place("roi"),
                      {place("roi.x_offset"), roi.x_offset},
                      {place("roi.y_offset"), roi.y_offset},
                      {place("roi.width"), roi.width},
                      {place("roi.height"), roi.height},
                      {place("roi.do_rectify"), roi.do_rectify}};
  }
  [[nodiscard]] std::string frame_id() const override { return info_.header.frame_id; }

 private:
  [[nodiscard]] InfoPlace place(const char* field) const {
    return {.name = source_ + ": " + field};
  }
  [[nodiscard]] InfoMatrix matrix(const char* field, std::span<const double> values) const {
    InfoMatrix matrix{place(field), {values.begin(), values.end()}};
    for (const double value : values)
      if (!std::isfinite(value)) matrix.place.fail("has a value that is no finite number");
    return matrix;
  }

  const CameraInfoMessage& info_;
  const std::string& source_;
};

}  // namespace

Camera camera_of(const CameraInfoMessage& info, const std::string& source, bool rectified) {
  return camera_of(InfoOfMessage(info, source), rectified);
}

}  // namespace penumbra::io
