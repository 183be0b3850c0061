// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>
#include <penumbra/calibration/watch.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/assembly/assembled_frame.hpp>
#include <io/assembly/cloud_input.hpp>

namespace penumbra::io {

/// Receives the judged frames of a camera, or the labelled scans of a sensor.
class FrameWatcher {
 public:
  FrameWatcher() = default;
  FrameWatcher(const FrameWatcher&) = delete;
  FrameWatcher& operator=(const FrameWatcher&) = delete;
  virtual ~FrameWatcher() = default;

  /// Returns whether jobs should hold their colour image. Any thread may call this.
  [[nodiscard]] virtual bool wants_color() const = 0;

  /// Receives a frame after its results were published. The camera's thread calls this and judges
  /// no other frame meanwhile: copy the data you need and return. `depth` is the judged image and
  /// may be empty, `drift` how far the camera is from its calibration. All arguments are valid
  /// during the call only.
  virtual void take(const AssembledFrame& job, const DepthView& depth, const FrameReport& report,
                    const Drift& drift) = 0;
  /// Receives a scan, likewise; does nothing for whoever watches cameras only.
  virtual void take_cloud(const ReceivedCloud& /*cloud*/, const CloudReport& /*report*/) {}
};

}  // namespace penumbra::io
