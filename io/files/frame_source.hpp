// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

#include <io/files/frame_reader.hpp>

namespace penumbra::io {

/// Where frames come from, one after the other: a recording folder or a bag.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// The next frame: what pictures need of it, and what the pipeline takes, which refers to `data`
  /// and to this and is valid until the next call. False at the end. What is wrong with a frame is
  /// its status.
  virtual bool next(FrameData& data, Frame& frame) = 0;

  /// How many frames there are in all, where it is known before the end.
  [[nodiscard]] virtual std::optional<std::size_t> size() const = 0;

  /// What was found wrong with the source itself, a line each. All of it is known at the end.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

}  // namespace penumbra::io
