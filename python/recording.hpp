// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <python/frame.hpp>

namespace penumbra::python {

/// A frame of a recording or bag, with its colour image.
struct RecordedFrame {
  OwnedFrame frame;
  SharedColor color;
  std::string color_message;
};

/// Images without an owner are copied.
[[nodiscard]] RecordedFrame recorded(Frame frame);

/// Python's own iterator over objects with __getitem__.
using FrameIterator = Shown<"Iterator[penumbra.RecordedFrame]">;

}  // namespace penumbra::python
