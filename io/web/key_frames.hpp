// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/web/report_page.hpp>

namespace penumbra::io {

/// The frames that a report shows: the first, the last, and those where a verdict or the frame's
/// status changes. If there are more than most_frames, those closest to their predecessors are left
/// out.
class KeyFrames {
 public:
  static constexpr std::size_t most_frames = 24;

  /// Adds a frame. `overlay`: its colour image with labels and targets.
  void add(const FrameReport& report, ImageView<const Rgb8> overlay);

  /// Returns the pictures, with indices counted from 0.
  [[nodiscard]] std::vector<PagePicture> pictures() const;

 private:
  void thin_out();

  std::vector<PagePicture> pictures_;
  std::vector<std::string> state_;  // status, targets and verdicts of the last frame
  Image<Rgb8> last_;
  std::size_t frames_ = 0;
};

}  // namespace penumbra::io
