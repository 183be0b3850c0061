// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra::io {

/// A sequence of frames: a recording folder or a bag.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Reads the next frame. Returns false at the end. Images without an owner are valid until the
  /// call after the next one, so that one frame can be read ahead.
  virtual bool next(Frame& frame) = 0;

  /// Returns the number of frames, if it is known before the end.
  [[nodiscard]] virtual std::optional<std::size_t> size() const = 0;

  /// Returns faults of the source, a line each. They are complete at the end.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

}  // namespace penumbra::io
