// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/pipeline/recent_depth-inl.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/target_stage.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {

/// Judges targets on labelled images, and keeps their depth for late targets.
class ImageJudge final : public SampleJudge {
 public:
  /// `labeller`: made with the same arguments. Robot and rectification (null without lens
  /// distortion) must outlive this. Throws InputError for a target_history out of range.
  ImageJudge(const Robot& robot, const Camera& camera, const Rectification* rectification,
             const FrameLabeller& labeller, const PipelineConfig& config);

  Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                  const std::optional<Eigen::Vector2d>& motion) override;
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p) const override {
    return views_.project(p);
  }
  void begin(const LabelledFrame& frame) override;
  const LabelledFrame& earlier(std::int64_t stamp, const PoseResult* poses) override;
  void forget() override { recent_depth_.clear(); }

 private:
  Camera camera_;  // of the judged images
  TargetJudge judge_;
  ObjectRenderers renderers_;
  TargetViews views_;
  RecentDepth recent_depth_;
  std::optional<FrameLabeller> late_labeller_;  // if target_history > 0
  std::optional<LabelledFrame> late_;           // the last late frame labelled in this call
  const LabelledFrame* judged_ = nullptr;       // the frame of the judge's begin()
};

}  // namespace penumbra
