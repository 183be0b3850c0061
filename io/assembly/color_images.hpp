// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/files/png.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// An image as it came, whose pixels are not decoded yet.
struct KeptImage {
  std::optional<ImageMessage> image;  ///< one of the two, which refers to what `owner` holds
  std::optional<CompressedImageMessage> compressed;
  std::shared_ptr<const void> owner;

  [[nodiscard]] const MessageHeader& header() const {
    return image ? image->header : compressed->header;
  }
};

/// `owner` keeps the message's pixels alive; null: they are copied.
template <typename M>
[[nodiscard]] KeptImage keep_image(const M& message, std::shared_ptr<const void> owner = nullptr);

/// Draws an image if it is one of `camera`; answers why not, or nothing.
[[nodiscard]] std::string decode_color(const KeptImage& color, const Camera& camera,
                                       Image<Rgb8>& image);

/// Color images, kept until the depth images of their stamps are shown. They are for pictures
/// alone.
class ColorImages {
 public:
  /// Depth and color of one instant may be stamped apart by so much, nanoseconds.
  static constexpr std::int64_t most_apart = 50'000'000;
  static constexpr const char* none_near = "no color image within 50 ms of the depth image's stamp";

  /// `most_images`: that are kept at a time.
  explicit ColorImages(std::size_t most_images) : most_images_(most_images) {}

  void add(KeptImage image);

  /// Whether the one of `stamp`, or one after it, has come.
  [[nodiscard]] bool reaches(std::int64_t stamp) const { return newest_ >= stamp; }

  /// The image that is nearest to `stamp`; null: none is near.
  [[nodiscard]] const KeptImage* find(std::int64_t stamp) const;

  /// Forgets what is older than a frame of `stamp` needs.
  void forget_before(std::int64_t stamp);

 private:
  std::size_t most_images_;
  std::deque<KeptImage> images_;  // as they came
  std::int64_t newest_ = 0;
};

}  // namespace penumbra::io
