// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
      recent_(history_span(config.target_history)) {
  if (config.target_history == 0.0) return;
  PipelineConfig alone = config;
  alone.rule.scene_memory = 0.0;
  late_labeller_.emplace(robot_, camera, lens(), alone);
}

LabelledFrame ImageJudge::label(const Frame& frame, PoseStage& poses) {
  const PoseResult& placed =
      poses.place(frame.pose, frame.stamp, frame.source_status, frame.source_message);
  LabelledFrame labelled = labeller_.label(frame.depth.view, placed);
  if (placed.known()) labelled.near_links = near_plane_.find(placed.T_camera_link);
  return labelled;
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
  const auto stamp = frame.stamp();
  if (!late_labeller_ || !stamp) return;
  std::visit(
      [&]<typename T>(const ImageView<const T>& depth) {
        constexpr std::size_t most = std::size_t{1} << 30U;  // bytes
        const std::size_t bytes = sizeof(T) * static_cast<std::size_t>(depth.width) *
                                  static_cast<std::size_t>(depth.height);
        auto& kept = recent_.at(*stamp, most / std::max<std::size_t>(bytes, 1));
        auto& copy = std::get<Image<T>>(kept);
        copy.fit(depth.width, depth.height);
        for (int v = 0; v < depth.height; ++v) std::copy_n(depth.row(v), depth.width, &copy(0, v));
        std::get<DepthView>(kept) = std::as_const(copy).view();
      },
      frame.depth);
}

/// Labels a stored frame again.
const LabelledFrame& ImageJudge::earlier(std::int64_t stamp, const PoseResult* poses) {
  if (!late_labeller_)
    throw InputError("its stamp is not the frame's, and no frames are stored (target_history)");
  if (late_ && late_->stamp() == stamp) return *late_;
  const auto* const kept = recent_.find(stamp);
  if (kept == nullptr || poses == nullptr)
    throw InputError("no frame of its stamp, " + std::to_string(stamp) + " ns, is stored");
  judged_ = nullptr;
  return late_.emplace(late_labeller_->label(std::get<DepthView>(*kept), *poses));
}

}  // namespace penumbra
