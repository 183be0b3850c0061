// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/image_judge-inl.hpp>

namespace penumbra {
namespace {

std::int64_t history_span(double seconds) {
  if (seconds >= 0.0 && seconds <= PipelineConfig::max_target_history)
    return static_cast<std::int64_t>(std::llround(seconds * 1e9));
  throw InputError("target_history is " + std::to_string(seconds) + " s; expected 0 to " +
                   std::to_string(PipelineConfig::max_target_history));
}

/// Returns the pixels of a rectified image that show nothing of the camera's image.
ImageView<const std::uint8_t> unseen_pixels(const FrameLabeller& labeller) {
  const auto& uncovered = labeller.uncovered();
  return uncovered && labeller.rectifies() ? uncovered->mask() : ImageView<const std::uint8_t>{};
}

std::optional<Rectification> rectification_of(const Camera& camera) {
  if (camera.distortion.is_none()) return std::nullopt;
  return std::optional<Rectification>(std::in_place, camera);
}

Camera without_distortion(Camera camera, const Intrinsics& intrinsics) {
  camera.intrinsics = intrinsics;
  camera.distortion = {};
  return camera;
}

/// Returns whether its depth is known without a measurement.
bool is_expected(const Target& target) {
  if (const auto* region = std::get_if<RegionTarget>(&target.shape))
    return region->expected_depth.has_value() || region->height.has_value();
  if (const auto* keypoint = std::get_if<KeypointTarget>(&target.shape))
    return keypoint->expected_depth.has_value();
  return !std::holds_alternative<std::monostate>(target.shape);
}

}  // namespace

ImageJudge::ImageJudge(const Robot& robot, const Camera& camera, const PipelineConfig& config)
    : robot_(robot),
      rectification_(rectification_of(camera.check())),
      labeller_(robot_, camera, lens(), config),
      near_plane_(labeller_.render_intrinsics(), bodies_of(robot_)),
      camera_(labeller_.rectifies() ? without_distortion(camera, labeller_.intrinsics()) : camera),
      judge_(camera_, labeller_.rule(), robot_.links().size() + max_attached,
             unseen_pixels(labeller_)),
      renderers_(labeller_.render_intrinsics(), config.backend, config.renderer,
                 labeller_.rectifies() ? nullptr : lens(), camera),
      views_(robot_, camera_, renderers_, labeller_.rule(),
             labeller_.rectifies() ? nullptr : lens()),
      recent_depth_(history_span(config.target_history)) {
  if (recent_depth_.is_enabled()) late_labeller_.emplace(robot_, camera, lens(), config);
}

LabelledFrame ImageJudge::label(const Frame& frame, PoseStage& poses) {
  return labeller_.label(frame.depth.view, poses.place(frame.pose, frame.stamp, frame.source_status,
                                                       frame.source_message));
}

Judgement ImageJudge::judge(const LabelledFrame& frame, const Target& target, TargetMemory* memory,
                            const std::optional<Eigen::Vector2d>& motion) {
  if (frame.images.evidence == Evidence::none && !is_expected(target))
    throw InputError(frame.fault());
  auto view = views_.view(target, frame.images, *frame.poses);
  if (!view) {
    Judgement outside;
    outside.verdict = Verdict::out_of_view;
    return outside;
  }
  if (judged_ != &frame) judge_.begin(frame.images);
  judged_ = &frame;
  view->motion = motion;
  return memory != nullptr ? judge_.judge(*view, *memory) : judge_.judge(*view);
}

void ImageJudge::begin(const LabelledFrame& frame) {
  judged_ = nullptr;
  late_.reset();
  if (const auto stamp = frame.stamp()) recent_depth_.keep(*stamp, frame.depth);
}

/// Labels a stored frame again.
const LabelledFrame& ImageJudge::earlier(std::int64_t stamp, const PoseResult* poses) {
  if (!late_labeller_)
    throw InputError("its stamp is not the frame's, and no frames are stored (target_history)");
  if (late_ && late_->stamp() == stamp) return *late_;
  const auto depth = recent_depth_.find(stamp);
  if (!depth || poses == nullptr) throw InputError("no frame of its stamp is stored");
  judged_ = nullptr;
  return late_.emplace(late_labeller_->label(*depth, *poses));
}

}  // namespace penumbra
