// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <utility>

#include <io/bag_frames/bag_colors.hpp>
#include <io/bag_frames/bag_scene.hpp>
#include <io/printable.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::io {

template <typename M>
void BagColors::add(const M& message) {
  Kept kept;
  kept.pixels.assign(message.data.begin(), message.data.end());
  M own = message;
  own.data = kept.pixels;
  if constexpr (std::is_same_v<M, ImageMessage>)
    kept.image = std::move(own);
  else
    kept.compressed = std::move(own);
  keep(std::move(kept));
}

template void BagColors::add(const ImageMessage&);
template void BagColors::add(const CompressedImageMessage&);

void BagColors::keep(Kept kept) {
  newest_ = std::max(newest_, kept.header().stamp);
  images_.push_back(std::move(kept));
  if (images_.size() > most_images) images_.pop_front();
}

bool BagColors::reaches(std::int64_t stamp) const { return newest_ >= stamp; }

std::string BagColors::find(std::int64_t stamp, Image<Rgb8>& image) const {
  const Kept* nearest = nullptr;
  std::int64_t apart = most_apart;
  for (const Kept& kept : images_) {
    const std::int64_t distance = std::abs(kept.header().stamp - stamp);
    if (distance > apart) continue;
    apart = distance;
    nearest = &kept;
  }
  if (nearest == nullptr) return "no color image within 50 ms of the depth image's stamp";
  const std::string& frame = nearest->header().frame_id;
  if (frame_name(frame) != frame_name(camera_.frame_id))
    return "the color image is of the frame '" + printable(frame) + "', the depth image of '" +
           camera_.frame_id + "'; --color-topic would bring depth into the color image";
  const auto fault = nearest->image ? decode_colour(*nearest->image, image)
                                    : decode_colour(*nearest->compressed, image);
  if (fault) return *fault;
  const Intrinsics& wanted = camera_.intrinsics;
  if (image.width() == wanted.width() && image.height() == wanted.height()) return {};
  return "the color image is " + std::to_string(image.width()) + " x " +
         std::to_string(image.height()) + " pixels, the depth image " +
         std::to_string(wanted.width()) + " x " + std::to_string(wanted.height());
}

void BagColors::forget_before(std::int64_t stamp) {
  while (!images_.empty() && images_.front().header().stamp < stamp - most_apart)
    images_.pop_front();
}

}  // namespace penumbra::io
