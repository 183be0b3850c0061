// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>

#include <Eigen/Core>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// Labels the frames of one sensor and judges targets on them: on the pixels of a camera's images,
/// or on the rays of scans.
class FrameJudge {
 public:
  FrameJudge() = default;
  FrameJudge(const FrameJudge&) = delete;
  FrameJudge& operator=(const FrameJudge&) = delete;
  virtual ~FrameJudge() = default;

  /// Labels a frame. The result refers to it and is valid until the next call.
  virtual LabelledFrame label(const Frame& frame, PoseStage& poses) = 0;

  /// Judges a checked target on a frame whose pose is known. `memory`: null for a target that is
  /// judged alone. `motion`: TargetView::motion. Throws InputError for why it is unknown.
  virtual Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                          const std::optional<Eigen::Vector2d>& motion) = 0;

  /// Returns the pixel of a point in the sensor's frame; null if there is none.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& /*p*/) const {
    return std::nullopt;
  }
  /// A new frame is judged. What it measured may be kept for targets that come late.
  virtual void begin(const LabelledFrame& frame) = 0;
  /// Returns the frame of an earlier stamp. `poses`: of it; null: not known. Throws InputError if
  /// it is not kept.
  virtual const LabelledFrame& earlier(std::int64_t stamp, const PoseResult* poses) = 0;
  virtual void forget() = 0;

  virtual void set_rule(const CloudRule& /*rule*/) {
    throw std::logic_error("this pipeline's sensor is a camera");
  }
};

}  // namespace penumbra
