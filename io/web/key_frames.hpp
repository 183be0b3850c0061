// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Encodes bytes by RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// Returns a picture that is embedded in a page: "data:image/jpeg;base64,...".
[[nodiscard]] std::string picture_uri(ImageView<const Rgb8> image);

/// The frames that a report shows: the first, the last, and those where a verdict or the frame's
/// status changes. If there are more than most_frames, those closest to their predecessors are left
/// out.
class KeyFrames {
 public:
  static constexpr std::size_t most_frames = 24;

  /// Adds a frame. `overlay`: its colour image with labels and targets.
  void add(const FrameReport& report, ImageView<const Rgb8> overlay);

  /// Returns [{"index": i, "image": "data:image/jpeg;base64,..."}], with i counted from 0.
  [[nodiscard]] std::string json() const;

 private:
  struct Picture {
    std::size_t frame;
    std::string uri;
  };
  void thin_out();

  std::vector<Picture> pictures_;
  std::vector<std::string> state_;  // status, targets and verdicts of the last frame
  Image<Rgb8> last_;
  std::size_t frames_ = 0;
};

}  // namespace penumbra::io
