// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <vector>

#include <io/assembly/color_images.hpp>
#include <io/assembly/frame_tree.hpp>
#include <io/files/printable.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::io {

template <typename M>
KeptImage keep_image(const M& message, std::shared_ptr<const void> owner) {
  M own = message;
  if (owner == nullptr) {
    auto pixels =
        std::make_shared<std::vector<std::byte>>(message.data.begin(), message.data.end());
    own.data = *pixels;
    owner = std::move(pixels);
  }
  KeptImage kept;
  kept.owner = std::move(owner);
  if constexpr (std::is_same_v<M, ImageMessage>)
    kept.image = std::move(own);
  else
    kept.compressed = std::move(own);
  return kept;
}

template KeptImage keep_image(const ImageMessage&, std::shared_ptr<const void>);
template KeptImage keep_image(const CompressedImageMessage&, std::shared_ptr<const void>);

KeptImage keep_frame(const CompressedVideoMessage& message, VideoStream& video) {
  auto pixels = std::make_shared<Image<Rgb8>>();
  KeptImage kept;
  kept.fault = video.decode(message.format, message.data, *pixels);
  kept.image = kept.fault.empty()
                   ? image_message(message.header, "rgb8", std::as_const(*pixels).view())
                   : ImageMessage{.header = message.header};
  kept.owner = std::move(pixels);
  return kept;
}

void ColorImages::add(KeptImage image) {
  newest_ = std::max(newest_, image.header().stamp);
  images_.push_back(std::move(image));
  if (images_.size() > most_images_) images_.pop_front();
}

const KeptImage* ColorImages::find(std::int64_t stamp) const {
  const KeptImage* nearest = nullptr;
  std::int64_t apart = most_apart;
  for (const KeptImage& kept : images_) {
    const std::int64_t distance = std::abs(kept.header().stamp - stamp);
    if (distance > apart) continue;
    apart = distance;
    nearest = &kept;
  }
  return nearest;
}

void ColorImages::forget_before(std::int64_t stamp) {
  while (!images_.empty() && images_.front().header().stamp < stamp - most_apart)
    images_.pop_front();
}

std::string decode_color(const KeptImage& color, const Camera& camera, Image<Rgb8>& image) {
  const std::string& frame = color.header().frame_id;
  if (frame_name(frame) != frame_name(camera.frame_id))
    return "the color image is of the frame '" + printable(frame) + "', the depth image of '" +
           camera.frame_id + "'; --color-topic would bring depth into the color image";
  if (!color.fault.empty()) return color.fault;
  const auto fault =
      color.image ? decode_color(*color.image, image) : decode_color(*color.compressed, image);
  if (fault) return *fault;
  const Intrinsics& wanted = camera.intrinsics;
  if (image.width() == wanted.width() && image.height() == wanted.height()) return {};
  return "the color image is " + std::to_string(image.width()) + " x " +
         std::to_string(image.height()) + " pixels, the depth image " +
         std::to_string(wanted.width()) + " x " + std::to_string(wanted.height());
}

}  // namespace penumbra::io
