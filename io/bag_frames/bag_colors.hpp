// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/png.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Color images of a bag, kept until the depth images of their stamps are shown. They are for
/// pictures alone.
class BagColors {
 public:
  /// Depth and color of one instant may be stamped apart by so much, nanoseconds.
  static constexpr std::int64_t most_apart = 50'000'000;

  /// `camera`: of the pictures.
  explicit BagColors(const Camera& camera) : camera_(camera) {}

  /// Keeps an image, of which `payload` is decoded when it is wanted.
  template <typename M>
  void add(const M& message);

  /// Whether the one of `stamp`, or one after it, has come.
  [[nodiscard]] bool reaches(std::int64_t stamp) const;

  /// Draws the image that is nearest to `stamp`; answers why there is none, or nothing.
  [[nodiscard]] std::string find(std::int64_t stamp, Image<Rgb8>& image) const;

  /// Forgets what is older than a frame of `stamp` needs.
  void forget_before(std::int64_t stamp);

 private:
  static constexpr std::size_t most_images = 64;

  /// A message with pixels of its own.
  struct Kept {
    std::vector<std::byte> pixels;
    std::optional<ImageMessage> image;
    std::optional<CompressedImageMessage> compressed;

    [[nodiscard]] const MessageHeader& header() const {
      return image ? image->header : compressed->header;
    }
  };
  void keep(Kept kept);

  Camera camera_;
  std::deque<Kept> images_;  // as they came
  std::int64_t newest_ = 0;
};

}  // namespace penumbra::io
