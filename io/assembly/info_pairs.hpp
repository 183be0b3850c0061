// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace penumbra::io {

/// Which images of a camera have a camera_info of their own, and whether its driver sends one with
/// each. Where it does, an image without one may be another camera's: a driver that was started
/// again. All stamps are nanoseconds.
class InfoPairs {
 public:
  /// Stamps of an image and its camera_info: drivers make them equal.
  static constexpr std::int64_t same_stamp = 1'000'000;

  /// Whether a stamp is that far behind the newest one that the clock was set back, as PoseHistory
  /// has it.
  [[nodiscard]] static bool is_jump(std::int64_t newest, std::int64_t stamp);

  void add_image(std::int64_t stamp);
  void add_info(std::int64_t stamp);

  /// Two images in succession had one each. Nothing that comes later changes that, so that a driver
  /// that starts again is not taken for one of another kind.
  [[nodiscard]] bool are_certain() const { return certain_; }
  /// One image had its own, so that others may.
  [[nodiscard]] bool are_likely() const { return certain_ || likely_; }
  /// One did not come: unless it is certain that it should have, none is waited for until one does.
  void doubt() { likely_ = false; }

  /// Whether the camera of an image is known: a camera_info of its stamp came, or of one that is
  /// somewhat later.
  [[nodiscard]] bool covers(std::int64_t image) const;

 private:
  struct ImageStamp {
    std::int64_t stamp = 0;
    std::int64_t info = 0;  // stamp of its own; 0: none came
  };
  void match(ImageStamp& image, std::int64_t info);
  void look_for_two();

  std::deque<ImageStamp> images_;
  std::deque<std::int64_t> infos_;  // as they came
  std::int64_t newest_image_ = 0, newest_info_ = 0;
  bool certain_ = false, likely_ = false;
};

}  // namespace penumbra::io
