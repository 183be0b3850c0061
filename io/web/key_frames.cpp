// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include <io/files/jpeg.hpp>
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

void append_frame(std::string& json, std::size_t frame, const std::string& picture) {
  json += (json.size() > 1 ? ",\n" : "") + std::string("{\"index\": ") + std::to_string(frame) +
          ", \"image\": \"" + picture + "\"}";
}

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0U;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::string picture_uri(ImageView<const Rgb8> image) {
  constexpr int quality = 80;
  std::vector<std::byte> jpeg;
  encode_jpeg(image, quality, jpeg);
  return "data:image/jpeg;base64," + base64(jpeg);
}

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
  const auto gap = [&](std::size_t i) { return pictures_[i].frame - pictures_[i - 1].frame; };
  for (std::size_t i = 2; i < pictures_.size(); ++i)
    if (gap(i) < gap(closest)) closest = i;
  pictures_.erase(pictures_.begin() + static_cast<std::ptrdiff_t>(closest));
}

std::string KeyFrames::json() const {
  std::string json = "[";
  for (const Picture& picture : pictures_) append_frame(json, picture.frame, picture.uri);
  const bool has_last = pictures_.empty() || pictures_.back().frame + 1 == frames_;
  if (!has_last) append_frame(json, frames_ - 1, picture_uri(std::as_const(last_).view()));
  return json + "]";
}

}  // namespace penumbra::io
