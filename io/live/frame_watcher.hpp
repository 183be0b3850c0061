// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/assembly/assembled_frame.hpp>

namespace penumbra::io {

/// Receives the judged frames of a sensor.
class FrameWatcher {
 public:
  FrameWatcher() = default;
  FrameWatcher(const FrameWatcher&) = delete;
  FrameWatcher& operator=(const FrameWatcher&) = delete;
  virtual ~FrameWatcher() = default;

  /// Returns whether jobs should hold their colour image. Any thread may call this.
  [[nodiscard]] virtual bool wants_color() const = 0;

  /// Receives a frame after its results were published. The sensor's thread calls this and judges
  /// no other frame meanwhile: copy the data you need and return. The job's depth is the judged
  /// image and may be empty; `drift` is how far a camera is from its calibration. All arguments are
  /// valid during the call only.
  virtual void take(const AssembledFrame& job, const FrameReport& report, const Drift& drift) = 0;
};

}  // namespace penumbra::io
