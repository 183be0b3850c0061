// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <io/web/key_frames.hpp>

namespace penumbra::io {
namespace {

std::vector<std::string> state_of(const FrameReport& report) {
  std::vector<std::string> state{std::string(to_string(report.status))};
  for (const TargetReport& target : report.targets) {
    state.emplace_back(target.name);
    state.emplace_back(to_string(target.verdict));
  }
  return state;
}

}  // namespace

void KeyFrames::add(const FrameReport& report, ImageView<const Rgb8> overlay) {
  if (last_.width() != overlay.width || last_.height() != overlay.height)
    last_ = Image<Rgb8>(overlay.width, overlay.height);
  for (int v = 0; v < overlay.height; ++v)
    std::copy_n(overlay.row(v), overlay.width, last_.view().row(v));
  const std::size_t frame = frames_++;
  std::vector<std::string> state = state_of(report);
  if (frame > 0 && state == state_) return;
  state_ = std::move(state);
  pictures_.push_back({frame, picture_uri(overlay)});
  if (pictures_.size() == most_frames) thin_out();  // the last frame needs room
}

void KeyFrames::thin_out() {
  std::size_t closest = 1;
  const auto gap = [&](std::size_t i) { return pictures_[i].index - pictures_[i - 1].index; };
  for (std::size_t i = 2; i < pictures_.size(); ++i)
    if (gap(i) < gap(closest)) closest = i;
  pictures_.erase(pictures_.begin() + static_cast<std::ptrdiff_t>(closest));
}

std::vector<PagePicture> KeyFrames::pictures() const {
  std::vector<PagePicture> pictures = pictures_;
  if (frames_ > 0 && pictures.back().index + 1 != frames_)
    pictures.push_back({frames_ - 1, picture_uri(last_.view())});
  return pictures;
}

}  // namespace penumbra::io
