// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace penumbra::io {

/// Matches the camera_infos of a topic to images by their stamps (nanoseconds).
///
/// A driver sends a camera_info with each image, once a second, or once. If it sends one with each
/// image, an image without one may be of another camera, because the driver may have restarted. An
/// image without its own may belong to the camera_info before it or after it: a recorder often
/// receives a driver's first camera_infos later than its images. Messages from before a backward
/// clock jump count only for images of that time.
class CameraInfos {
 public:
  /// The largest difference between the stamps of an image and its camera_info. Drivers set equal
  /// stamps.
  static constexpr std::int64_t same_stamp = 1'000'000;

  void add_image(std::int64_t stamp);
  /// `differs`: the message describes another camera than the first one.
  void add_info(std::int64_t stamp, bool differs = false);

  /// Returns whether two consecutive images had a camera_info each. This never becomes false again,
  /// so that a restarted driver is treated like before.
  [[nodiscard]] bool are_certain() const { return certain_; }
  /// Returns whether at least one image had its own camera_info, so that others may have one.
  [[nodiscard]] bool are_likely() const { return certain_ || likely_; }
  /// Records that an image has no camera_info of its own. Unless are_certain(), no further image
  /// waits for one until one arrives.
  void note_missing() { likely_ = false; }

  /// Returns whether a camera_info with the image's stamp, or a slightly later one, was received.
  [[nodiscard]] bool covers(std::int64_t image) const;
  /// Returns whether a camera_info with this stamp or a later one was received.
  [[nodiscard]] bool reaches(std::int64_t stamp) const;
  /// Returns whether an image may be of another camera, by the messages received so far.
  [[nodiscard]] bool differs(std::int64_t image) const;
  /// Returns whether the last camera_info differed.
  [[nodiscard]] bool last_differs() const { return last_differs_; }

 private:
  struct ImageStamp {
    std::int64_t stamp = 0;
    std::int64_t info = 0;  // stamp of its own camera_info; 0 if there is none
  };
  struct Info {
    std::int64_t stamp = 0;
    bool differs = false;
  };
  void match(ImageStamp& image, std::int64_t info);
  void update_certainty();
  void begin_epoch();

  std::deque<ImageStamp> images_;
  std::deque<Info> infos_;   // in the order of arrival
  std::deque<Info> before_;  // from before the clock jumped back
  std::int64_t newest_image_ = 0, newest_info_ = 0;
  bool certain_ = false, likely_ = false;
  bool last_differs_ = false, differed_before_ = false;
};

}  // namespace penumbra::io
