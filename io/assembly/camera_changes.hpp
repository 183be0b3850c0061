// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace penumbra::io {

/// When the camera_infos of a topic were another camera's than at first. An image without one of
/// its own stamp may be of that before it or of that behind it: a recorder often hears the first
/// ones of a driver later than its images. What came before the clock jumped back counts for images
/// of that time alone. All stamps are nanoseconds.
class CameraChanges {
 public:
  void add_image(std::int64_t stamp);
  void add_info(std::int64_t stamp, bool differs);

  /// Whether an image of that stamp may be of another camera, as far as was told until now.
  [[nodiscard]] bool differs(std::int64_t image) const;
  /// Whether what came last was another camera's.
  [[nodiscard]] bool differs() const { return last_differs_; }
  /// Whether a camera_info came of that stamp or after.
  [[nodiscard]] bool reaches(std::int64_t stamp) const;

 private:
  struct Info {
    std::int64_t stamp = 0;
    bool differs = false;
  };
  void begin_anew();

  std::deque<Info> infos_;   // as they came
  std::deque<Info> before_;  // the clock jumped back
  std::int64_t newest_image_ = 0, newest_info_ = 0;
  bool last_differs_ = false, differed_before_ = false;
};

}  // namespace penumbra::io
