// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include <penumbra/base/stamps.hpp>

#include <io/assembly/camera_infos.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_matched_images = 8;
/// Images arrive late and wait for their poses: this covers more than 2 s at 90 Hz.
constexpr std::size_t most_infos = 256;
/// A camera_info does not cover images that are older by more than this. After a clock reset all
/// earlier messages have later stamps.
constexpr std::int64_t longest_cover = 1'000'000'000;

}  // namespace

void CameraInfos::match(ImageStamp& image, std::int64_t info) {
  if (image.stamp <= 0 || std::abs(image.stamp - info) > same_stamp) return;
  image.info = info;
  likely_ = true;
}

void CameraInfos::update_certainty() {
  for (std::size_t i = 1; i < images_.size(); ++i) {
    const std::int64_t one = images_[i - 1].info, other = images_[i].info;
    certain_ |= one != 0 && other != 0 && one != other;  // one camera_info may match twice
  }
}

void CameraInfos::begin_epoch() {
  before_ = std::exchange(infos_, {});
  differed_before_ = last_differs_;
  newest_image_ = newest_info_ = 0;
}

void CameraInfos::add_image(std::int64_t stamp) {
  if (stamp > 0 && is_clock_jump(stamp, newest_image_)) {
    if (is_clock_jump(stamp, newest_info_)) begin_epoch();
    newest_image_ = 0;
  }
  newest_image_ = std::max(newest_image_, stamp);
  images_.push_back({stamp});
  if (images_.size() > most_matched_images) images_.pop_front();
  for (const Info& info : infos_) match(images_.back(), info.stamp);
  update_certainty();
}

void CameraInfos::add_info(std::int64_t stamp, bool differs) {
  if (is_clock_jump(stamp, newest_info_)) begin_epoch();
  newest_info_ = std::max(newest_info_, stamp);
  infos_.push_back({stamp, differs});
  if (infos_.size() > most_infos) infos_.pop_front();
  last_differs_ = differs;
  for (ImageStamp& image : images_) match(image, stamp);
  update_certainty();
}

bool CameraInfos::covers(std::int64_t image) const {
  return std::any_of(infos_.begin(), infos_.end(), [&](const Info& info) {
    return info.stamp >= image - same_stamp && info.stamp <= image + longest_cover;
  });
}

bool CameraInfos::reaches(std::int64_t stamp) const {
  return newest_info_ > 0 && newest_info_ >= stamp;
}

bool CameraInfos::differs(std::int64_t image) const {
  const bool is_of_before = is_clock_jump(std::max(newest_image_, newest_info_), image);
  const Info* before = nullptr;
  const Info* next = nullptr;  // the image's own, if it has one
  for (const Info& info : is_of_before ? before_ : infos_) {
    if (info.stamp < image - same_stamp) {
      if (before == nullptr || info.stamp >= before->stamp) before = &info;
    } else if (next == nullptr || info.stamp < next->stamp) {
      next = &info;
    }
  }
  const bool has_own = next != nullptr && next->stamp <= image + same_stamp;
  if (has_own || (next != nullptr && next->differs)) return next->differs;
  return before != nullptr ? before->differs : differed_before_;
}

}  // namespace penumbra::io
