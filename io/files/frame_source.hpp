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

  /// Reads the next frame. Returns false at the end.
  virtual bool next(Frame& frame) { return read(next_++, frame); }

  /// Reads the frame with a number, from 0, which owns its images. Returns false after the last. At
  /// most at_once() frames may be read at the same time; if that is 1, in order.
  virtual bool read(std::size_t number, Frame& frame) = 0;
  [[nodiscard]] virtual std::size_t at_once() const { return 1; }

  /// Returns the number of frames, if it is known before the end.
  [[nodiscard]] virtual std::optional<std::size_t> size() const = 0;

  /// Returns faults of the source, a line each. They are complete at the end.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;

 private:
  std::size_t next_ = 0;
};

}  // namespace penumbra::io
