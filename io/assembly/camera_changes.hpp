// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace penumbra::io {

/// Records when the camera_infos of a topic differ from the first one. An image without a
/// camera_info of its own stamp may belong to the one before it or the one after it, because a
/// recorder often receives a driver's first camera_infos later than its images. Messages from
/// before a backward clock jump count only for images of that time. All stamps are nanoseconds.
class CameraChanges {
 public:
  void add_image(std::int64_t stamp);
  void add_info(std::int64_t stamp, bool differs);

  /// Returns whether an image with this stamp may be of another camera, by the messages received so
  /// far.
  [[nodiscard]] bool differs(std::int64_t image) const;
  /// Returns whether the last camera_info was of another camera.
  [[nodiscard]] bool differs() const { return last_differs_; }
  /// Returns whether a camera_info with this stamp or a later one was received.
  [[nodiscard]] bool reaches(std::int64_t stamp) const;

 private:
  struct Info {
    std::int64_t stamp = 0;
    bool differs = false;
  };
  void begin_anew();

  std::deque<Info> infos_;   // in the order of arrival
  std::deque<Info> before_;  // from before the clock jumped back
  std::int64_t newest_image_ = 0, newest_info_ = 0;
  bool last_differs_ = false, differed_before_ = false;
};

}  // namespace penumbra::io
