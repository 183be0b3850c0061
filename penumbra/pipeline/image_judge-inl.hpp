// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include <Eigen/Core>

#include <penumbra/base/recent_values.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame_judge-inl.hpp>
#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/render/near_plane_check.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {

/// Labels a camera's images, judges targets on them, and keeps their depth for late targets.
class ImageJudge final : public FrameJudge {
 public:
  /// Throws InputError for a target_history out of range, and as Camera, LabelRule and
  /// make_depth_renderer do.
  ImageJudge(const Robot& robot, const Camera& camera, const PipelineConfig& config);

  LabelledFrame label(const Frame& frame, PoseStage& poses) override;
  [[nodiscard]] const FrameLabeller& labeller() const { return labeller_; }
  /// Returns the camera of the labelled images: without distortion if they are rectified.
  [[nodiscard]] const Camera& camera() const { return camera_; }
  /// Maps the camera's images to the labelled ones; null if they are the same.
  [[nodiscard]] const Rectification* rectification() const {
    return labeller_.rectifies() ? lens() : nullptr;
  }
  Judgement judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                  const std::optional<Eigen::Vector2d>& motion) override;
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p) const override {
    return views_.project(p);
  }
  void begin(const LabelledFrame& frame) override;
  const LabelledFrame& earlier(std::int64_t stamp, const PoseResult* poses) override;
  void forget() override {
    recent_.clear();
    labeller_.forget();
  }

 private:
  [[nodiscard]] const Rectification* lens() const {
    return rectification_ ? &*rectification_ : nullptr;
  }

  Robot robot_;
  std::optional<Rectification> rectification_;  // null without lens distortion
  FrameLabeller labeller_;
  NearPlaneCheck near_plane_;
  Camera camera_;
  TargetJudge judge_;
  ObjectRenderers renderers_;
  TargetViews views_;
  /// Images of earlier frames, each with a view of one of its copies; empty: it had none.
  RecentValues<std::tuple<DepthView, Image<std::uint16_t>, Image<float>>> recent_;
  std::optional<FrameLabeller> late_labeller_;  // if target_history > 0
  std::optional<LabelledFrame> late_;           // the last late frame labelled in this call
  const LabelledFrame* judged_ = nullptr;       // the frame of the judge's begin()
};

}  // namespace penumbra
