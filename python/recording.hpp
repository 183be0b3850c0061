// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <python/frame.hpp>

#include <io/files/frame_reader.hpp>

namespace penumbra::python {

/// A recorded frame that keeps its images.
struct RecordedFrame {
  std::shared_ptr<io::FrameData> data;
  OwnedFrame frame;  ///< its depth lies in `data`
};

/// Of the frame that a source made of `data`; where its depth image lies elsewhere `data` gets a
/// copy. `targets`: what the source gave.
[[nodiscard]] RecordedFrame recorded(std::shared_ptr<io::FrameData> data, const Frame& frame,
                                     OwnedTargets targets);

/// Python's own iterator over objects with __getitem__.
using FrameIterator = Shown<"Iterator[penumbra.RecordedFrame]">;

}  // namespace penumbra::python
