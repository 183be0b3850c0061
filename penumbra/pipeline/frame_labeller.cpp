// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <variant>

#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/pipeline/stage_timer-inl.hpp>

namespace penumbra {

std::vector<Body> bodies_of(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

LabelRule rule_of(const Camera& camera, const PipelineConfig& config) {
  LabelRule rule = config.rule;
  rule.range.near = std::max(rule.range.near, camera.range.near);
  rule.range.far = std::min(rule.range.far, camera.range.far);
  return rule;
}

FrameLabeller::FrameLabeller(const Robot& robot, const Camera& camera,
                             const Rectification* rectification, const PipelineConfig& config)
    : render_intrinsics_(rectification ? rectification->pinhole() : camera.intrinsics),
      intrinsics_(config.image == ImageSpace::raw ? camera.intrinsics : render_intrinsics_),
      renderer_(make_depth_renderer(config.backend, render_intrinsics_, bodies_of(robot),
                                    config.renderer)),
      classifier_(intrinsics_.width(), intrinsics_.height(), rule_of(camera, config),
                  config.backend == Backend::reference ? "scalar" : config.renderer.isa),
      no_depth_row_(static_cast<std::size_t>(intrinsics_.width())) {
  if (rectification == nullptr) return;
  if (config.image == ImageSpace::raw) {
    raw_images_.emplace(*rectification);
    uncovered_.emplace(rectification->raw_to_pinhole());
  } else {
    rectified_depth_.emplace(*rectification);
    uncovered_.emplace(rectification->pinhole_to_raw());
  }
}

JudgedImages FrameLabeller::label(std::span<const Eigen::Isometry3d> T_camera_link,
                                  const DepthView& depth, StageTimes& timing) {
  JudgedImages images;
  images.is_blind = std::visit([](const auto& view) { return view.empty(); }, depth);
  {
    const StageTimer timer(timing.render);
    images.virtual_depth = draw(T_camera_link);
  }
  const StageTimer timer(timing.classify);
  if (!images.is_blind)
    images.measured = rectified_depth_ ? rectified_depth_->rectify(depth) : depth;
  images.labels = classify(images.virtual_depth, images.measured);
  return images;
}

VirtualDepthView FrameLabeller::draw(std::span<const Eigen::Isometry3d> T_camera_link) {
  const VirtualDepthView drawn = renderer_->render(T_camera_link);
  return raw_images_ ? raw_images_->virtual_depth(drawn) : drawn;
}

LabelView FrameLabeller::classify(const VirtualDepthView& virtual_depth,
                                  const DepthView& measured) {
  const bool is_empty = std::visit([](const auto& view) { return view.empty(); }, measured);
  const ImageView<const std::uint16_t> no_depth{no_depth_row_.data(), intrinsics_.width(),
                                                intrinsics_.height(), 0};
  const LabelView labels =
      classifier_.classify(virtual_depth, is_empty ? DepthView(no_depth) : measured);
  return uncovered_ ? uncovered_->mark(labels) : labels;
}

}  // namespace penumbra
