// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace penumbra::io {

/// Finds which images of a camera have a camera_info of their own, and whether the driver sends one
/// with each image. If it does, an image without one may be another camera's: the driver may have
/// restarted. All stamps are nanoseconds.
class InfoPairs {
 public:
  /// The largest difference between the stamps of an image and its camera_info. Drivers set equal
  /// stamps.
  static constexpr std::int64_t same_stamp = 1'000'000;

  /// Returns whether a stamp is so far before the newest one that the clock was set back, by the
  /// rule of PoseHistory.
  [[nodiscard]] static bool is_jump(std::int64_t newest, std::int64_t stamp);

  void add_image(std::int64_t stamp);
  void add_info(std::int64_t stamp);

  /// Returns whether two consecutive images had a camera_info each. This never becomes false again,
  /// so that a restarted driver is treated like before.
  [[nodiscard]] bool are_certain() const { return certain_; }
  /// Returns whether at least one image had its own camera_info, so that others may have one.
  [[nodiscard]] bool are_likely() const { return certain_ || likely_; }
  /// Records that an image has no camera_info of its own. Unless are_certain(), no further image
  /// waits for one until one arrives.
  void note_missing() { likely_ = false; }

  /// Returns whether the camera of an image is known: a camera_info with its stamp, or a slightly
  /// later one, was received.
  [[nodiscard]] bool covers(std::int64_t image) const;

 private:
  struct ImageStamp {
    std::int64_t stamp = 0;
    std::int64_t info = 0;  // stamp of its own camera_info; 0 if there is none
  };
  void match(ImageStamp& image, std::int64_t info);
  void update_certainty();

  std::deque<ImageStamp> images_;
  std::deque<std::int64_t> infos_;  // in the order of arrival
  std::int64_t newest_image_ = 0, newest_info_ = 0;
  bool certain_ = false, likely_ = false;
};

}  // namespace penumbra::io
