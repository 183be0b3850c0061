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
#include <io/files/video_file.hpp>
#include <io/ros/foxglove_messages.hpp>

namespace penumbra::io {

/// A received image that is not decoded yet.
struct KeptImage {
  std::optional<ImageMessage> image;  ///< one of the two is set; it views the data of `owner`
  std::optional<CompressedImageMessage> compressed;
  std::shared_ptr<const void> owner;
  std::string fault = {};  ///< why a video's frame has no pixels

  [[nodiscard]] bool is_empty() const { return !image && !compressed; }
  [[nodiscard]] const MessageHeader& header() const {
    return image ? image->header : compressed->header;
  }
};

/// Keeps a received image. `owner` keeps the message's pixels alive; if it is null, they are
/// copied.
template <typename M>
[[nodiscard]] KeptImage keep_image(const M& message, std::shared_ptr<const void> owner = nullptr);

/// Decodes the next frame of a video.
[[nodiscard]] KeptImage keep_frame(const CompressedVideoMessage& message, VideoStream& video);

/// Decodes an image if it has the frame and size of `camera`. Returns why it does not, or an empty
/// text.
[[nodiscard]] std::string decode_color(const KeptImage& color, const Camera& camera,
                                       Image<Rgb8>& image);

/// Keeps colour images until the depth images with their stamps are shown. They are used for
/// pictures only.
class ColorImages {
 public:
  /// The largest difference between the stamps of a depth image and its colour image, in
  /// nanoseconds.
  static constexpr std::int64_t most_apart = 50'000'000;
  static constexpr const char* none_near = "no color image within 50 ms of the depth image's stamp";

  /// `most_images`: the number of images kept at a time.
  explicit ColorImages(std::size_t most_images) : most_images_(most_images) {}

  void add(KeptImage image);

  /// Returns whether an image with this stamp or a later one was received.
  [[nodiscard]] bool reaches(std::int64_t stamp) const { return newest_ >= stamp; }

  /// Returns the image nearest to `stamp`, or null if none is within most_apart.
  [[nodiscard]] const KeptImage* find(std::int64_t stamp) const;

  /// Removes images that are too old for a frame with this stamp.
  void forget_before(std::int64_t stamp);

 private:
  std::size_t most_images_;
  std::deque<KeptImage> images_;  // in the order of arrival
  std::int64_t newest_ = 0;
};

}  // namespace penumbra::io
