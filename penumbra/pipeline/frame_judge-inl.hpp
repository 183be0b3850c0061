// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/targets/target_stage.hpp>

namespace penumbra {

/// Labels the frames of a camera, or of a sensor of points, and judges targets on them.
class FrameJudge : public SampleJudge {
 public:
  /// Labels a frame. The result refers to it and is valid until the next call.
  virtual LabelledFrame label(const Frame& frame, PoseStage& poses) = 0;
  /// In how many parts the last frame was labelled, each with its own poses; 0 for images.
  [[nodiscard]] virtual std::size_t parts() const { return 0; }
  virtual void set_rule(const CloudRule& /*rule*/) {
    throw std::logic_error("this pipeline's sensor is a camera");
  }
};

}  // namespace penumbra
