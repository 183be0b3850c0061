// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/live/live_job.hpp>

namespace penumbra::io {

/// Receives a camera's frames as they were judged.
class FrameWatcher {
 public:
  FrameWatcher() = default;
  FrameWatcher(const FrameWatcher&) = delete;
  FrameWatcher& operator=(const FrameWatcher&) = delete;
  virtual ~FrameWatcher() = default;

  /// Returns whether jobs should hold their colour image. Called by any thread.
  [[nodiscard]] virtual bool wants_color() const = 0;

  /// Takes a frame after its results were published. The camera's thread calls this and judges
  /// nothing meanwhile: copy what is needed and return. `depth` is the judged image and may be
  /// empty. All arguments are valid during the call only.
  virtual void take(const LiveJob& job, const DepthView& depth, const FrameReport& report) = 0;
};

}  // namespace penumbra::io
