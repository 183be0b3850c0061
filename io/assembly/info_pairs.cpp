// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <penumbra/base/stamps.hpp>

#include <io/assembly/info_pairs.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_waiting_images = 8;
/// Images may arrive late: this covers more than 2 s at 90 Hz.
constexpr std::size_t most_infos = 256;
/// A camera_info does not apply to images that are older by more than this. After a clock reset all
/// earlier messages have later stamps.
constexpr std::int64_t longest_cover = 1'000'000'000;

}  // namespace

bool InfoPairs::is_jump(std::int64_t newest, std::int64_t stamp) {
  return is_clock_jump(stamp, newest);
}

void InfoPairs::match(ImageStamp& image, std::int64_t info) {
  if (image.stamp <= 0 || std::abs(image.stamp - info) > same_stamp) return;
  image.info = info;
  likely_ = true;
}

void InfoPairs::update_certainty() {
  for (std::size_t i = 1; i < images_.size(); ++i) {
    const std::int64_t one = images_[i - 1].info, other = images_[i].info;
    certain_ |= one != 0 && other != 0 && one != other;  // one camera_info may pair twice
  }
}

void InfoPairs::add_image(std::int64_t stamp) {
  const bool jumped = stamp > 0 && is_jump(newest_image_, stamp);
  newest_image_ = jumped ? stamp : std::max(newest_image_, stamp);
  if (jumped && is_jump(newest_info_, stamp)) {
    infos_.clear();
    newest_info_ = 0;
  }
  images_.push_back({stamp});
  if (images_.size() > most_waiting_images) images_.pop_front();
  for (const std::int64_t info : infos_) match(images_.back(), info);
  update_certainty();
}

void InfoPairs::add_info(std::int64_t stamp) {
  if (is_jump(newest_info_, stamp)) {
    infos_.clear();
    newest_info_ = stamp;
  }
  newest_info_ = std::max(newest_info_, stamp);
  infos_.push_back(stamp);
  if (infos_.size() > most_infos) infos_.pop_front();
  for (ImageStamp& image : images_) match(image, stamp);
  update_certainty();
}

bool InfoPairs::covers(std::int64_t image) const {
  return std::any_of(infos_.begin(), infos_.end(), [&](std::int64_t info) {
    return info >= image - same_stamp && info <= image + longest_cover;
  });
}

}  // namespace penumbra::io
