// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <io/assembly/camera_changes.hpp>
#include <io/assembly/info_pairs.hpp>

namespace penumbra::io {
namespace {

/// Images wait for their poses: this covers more than 2 s at 90 Hz.
constexpr std::size_t most_kept_infos = 256;

}  // namespace

void CameraChanges::add_image(std::int64_t stamp) {
  if (stamp <= 0) return;
  if (InfoPairs::is_jump(newest_image_, stamp)) {
    if (InfoPairs::is_jump(newest_info_, stamp)) begin_anew();
    newest_image_ = 0;
  }
  newest_image_ = std::max(newest_image_, stamp);
}

void CameraChanges::begin_anew() {
  before_ = std::exchange(infos_, {});
  differed_before_ = last_differs_;
  newest_image_ = newest_info_ = 0;
}

void CameraChanges::add_info(std::int64_t stamp, bool differs) {
  if (InfoPairs::is_jump(newest_info_, stamp)) begin_anew();
  newest_info_ = std::max(newest_info_, stamp);
  infos_.push_back({stamp, differs});
  if (infos_.size() > most_kept_infos) infos_.pop_front();
  last_differs_ = differs;
}

bool CameraChanges::differs(std::int64_t image) const {
  const bool is_of_before = InfoPairs::is_jump(image, std::max(newest_image_, newest_info_));
  const Info* before = nullptr;
  const Info* next = nullptr;  // the image's own, if it has one
  for (const Info& info : is_of_before ? before_ : infos_) {
    if (info.stamp < image - InfoPairs::same_stamp) {
      if (before == nullptr || info.stamp >= before->stamp) before = &info;
    } else if (next == nullptr || info.stamp < next->stamp) {
      next = &info;
    }
  }
  const bool has_own = next != nullptr && next->stamp <= image + InfoPairs::same_stamp;
  if (has_own || (next != nullptr && next->differs)) return next->differs;
  return before != nullptr ? before->differs : differed_before_;
}

bool CameraChanges::reaches(std::int64_t stamp) const {
  return newest_info_ > 0 && newest_info_ >= stamp;
}

}  // namespace penumbra::io
