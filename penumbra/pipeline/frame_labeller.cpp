// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <tuple>
#include <utility>
#include <variant>

#include <penumbra/labels/rule.hpp>
#include <penumbra/pipeline/frame_labeller-inl.hpp>
#include <penumbra/poses/pose_stage.hpp>

namespace penumbra {
namespace {

template <typename T>
bool holds_measurement(ImageView<const T> depth, const labelling::Rule& rule) {
  const Measured measured(depth, rule);
  for (int v = 0; v < depth.height; ++v) {
    const auto row = measured.row(v);
    std::int32_t count = 0;  // whole rows without branches, so that the loop is vectorised
    for (int u = 0; u < depth.width; ++u) count += row.is_measured(u) ? 1 : 0;
    if (count > 0) return true;
  }
  return false;
}

std::string without_measurement(const DepthRange& range) {
  std::ostringstream text;
  text << "no pixel of the depth image holds a measurement";
  if (range.near > 0.0 || std::isfinite(range.far))
    text << " within " << range.near << " to " << range.far << " m";
  return text.str();
}

}  // namespace

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
      attached_(render_intrinsics_, config.backend, config.renderer),
      classifier_(intrinsics_.width(), intrinsics_.height(), rule_of(camera, config),
                  config.renderer.isa),
      has_depth_(config.has_depth),
      depth_size_(camera.intrinsics.width(), camera.intrinsics.height()),
      measured_(classifier_.rule()),
      no_depth_row_(static_cast<std::size_t>(intrinsics_.width())),
      unknown_row_(no_depth_row_.size(), static_cast<std::uint8_t>(Label::unknown)) {
  if (rule().fringe_reach > 0 && rule().scene_memory > 0.0)
    memory_.emplace(intrinsics_.width(), intrinsics_.height(), rule(), config.renderer.isa);
  if (rectification == nullptr) return;
  if (config.image == ImageSpace::raw) {
    raw_images_.emplace(*rectification);
    uncovered_.emplace(rectification->raw_to_pinhole());
  } else {
    rectified_depth_.emplace(*rectification);
    uncovered_.emplace(rectification->pinhole_to_raw());
  }
}

LabelledFrame FrameLabeller::label(const DepthView& depth, const PoseResult& poses) {
  LabelledFrame frame{
      .poses = &poses, .status = poses.status, .message = poses.message, .depth = depth};
  LabelledImages& images = frame.images;
  images.evidence = Evidence::none;
  if (!poses.known()) {
    images.labels = frame.labels = unknown_labels();
    frame.uncovered = uncovered_ ? uncovered_->count() : 0;
    return frame;
  }
  if (has_depth_ && has_depth(frame.status)) frame.status = worse(frame.status, check(frame));
  if (has_depth(frame.status))
    images.evidence = has_depth_ ? Evidence::measured : Evidence::assumed_free;
  if (!poses.missing_links.empty()) images.undrawn = frame.message;
  if (images.evidence == Evidence::none || !poses.reaches.empty()) images.fault = frame.fault();
  images.link_names = poses.links;
  VirtualDepthView robot;
  {
    const StageTimer timer(frame.render_ms);
    robot = renderer_->render(poses.T_camera_link);
    images.virtual_depth = add(robot, poses.attached, {});
  }
  {
    const StageTimer timer(frame.classify_ms);
    if (images.evidence == Evidence::measured)
      images.measured = rectified_depth_ ? rectified_depth_->rectify(depth) : depth;
    const bool is_whole = images.evidence == Evidence::measured && poses.missing_links.empty() &&
                          poses.reaches.empty();
    const bool remembers = memory_ && poses.stamp && is_whole;
    if (remembers)
      memory_->update(poses.T_root_camera, *poses.stamp, images.virtual_depth, images.measured);
    images.labels = classify(images.virtual_depth, images.measured,
                             remembers ? memory_->depth() : ImageView<const std::uint16_t>{});
    if (!poses.reaches.empty()) add_reaches(images, robot, poses);
  }
  frame.labels = images.labels;
  if (!poses.missing_links.empty() || (has_depth_ && images.evidence == Evidence::none))
    frame.labels = without_trusted(images.labels);
  frame.uncovered = uncovered_ ? uncovered_->marked() : 0;
  return frame;
}

/// Checks the depth image.
FrameStatus FrameLabeller::check(LabelledFrame& frame) {
  const auto fault = [&](FrameStatus status, std::string_view part) {
    message_ = frame.message;
    add_part(message_, part);
    frame.message = message_;
    return status;
  };
  const auto [empty, width, height] =
      std::visit([](const auto& view) { return std::tuple(view.empty(), view.width, view.height); },
                 frame.depth);
  if (empty) return fault(FrameStatus::missing_depth, "no depth image");
  if (depth_size_ != Eigen::Vector2i(width, height))
    return fault(FrameStatus::bad_depth, "depth image is " + std::to_string(width) + "x" +
                                             std::to_string(height) + ", expected " +
                                             std::to_string(depth_size_.x()) + "x" +
                                             std::to_string(depth_size_.y()));
  frame.nothing_measured = !std::visit(
      [&](const auto& view) { return holds_measurement(view, measured_); }, frame.depth);
  if (!frame.nothing_measured) return FrameStatus::ok;
  return fault(FrameStatus::bad_depth, without_measurement(rule().range));
}

LabelView FrameLabeller::unknown_labels() const {
  LabelView view{{unknown_row_.data(), intrinsics_.width(), intrinsics_.height(), 0}};
  view.pixels[static_cast<std::size_t>(Label::unknown)] =
      unknown_row_.size() * static_cast<std::size_t>(intrinsics_.height()) -
      (uncovered_ ? uncovered_->count() : 0);
  return view;
}

/// Adds what links of unknown pose could hide to images of the others, whose fringe stays.
void FrameLabeller::add_reaches(LabelledImages& images, const VirtualDepthView& robot,
                                const PoseResult& poses) {
  const ImageView<const std::uint8_t> known = images.labels.labels;
  labels_with_reaches_.fit(known.width, known.height);
  for (int v = 0; v < known.height; ++v)
    std::copy_n(known.row(v), known.width, &labels_with_reaches_(0, v));
  images.virtual_depth = add(robot, poses.attached, poses.reaches);
  unplaced_.clear();
  for (const Reach& reach : poses.reaches)
    unplaced_.push_back(static_cast<std::uint16_t>(reach.link + 1));
  images.unplaced = unplaced_;
  images.labels =
      unknown_in_reaches(classify(images.virtual_depth, images.measured),
                         images.virtual_depth.links, poses.reaches, labels_with_reaches_);
}

/// Returns the labels of a frame in which something is not drawn or nothing is measured: whatever
/// the robot does not certainly hide is unknown.
LabelView FrameLabeller::without_trusted(const LabelView& labels) {
  LabelView result{.labels = {}, .pixels = {}, .touched = nullptr};
  untrusted_.fit(labels.labels.width, labels.labels.height);
  for (int v = 0; v < untrusted_.height(); ++v)
    std::transform(labels.labels.row(v), labels.labels.row(v) + untrusted_.width(),
                   &untrusted_(0, v), [](std::uint8_t value) {
                     const auto label = static_cast<Label>(value);
                     return label == Label::occluded || label == Label::beyond
                                ? value
                                : static_cast<std::uint8_t>(Label::unknown);
                   });
  result.labels = std::as_const(untrusted_).view();
  for (std::size_t label = 0; label < label_count; ++label) {
    const bool is_hidden =
        static_cast<Label>(label) == Label::occluded || static_cast<Label>(label) == Label::beyond;
    result.pixels[is_hidden ? label : static_cast<std::size_t>(Label::unknown)] +=
        labels.pixels[label];
  }
  return result;
}

VirtualDepthView FrameLabeller::add(const VirtualDepthView& robot,
                                    std::span<const PlacedBody> bodies,
                                    std::span<const Reach> reaches) {
  const bool is_alone = bodies.empty() && reaches.empty();
  const VirtualDepthView drawn = is_alone ? robot : attached_.add_to(robot, bodies, reaches);
  return raw_images_ ? raw_images_->virtual_depth(drawn) : drawn;
}

LabelView FrameLabeller::classify(const VirtualDepthView& virtual_depth, const DepthView& measured,
                                  ImageView<const std::uint16_t> known) {
  const ImageView<const std::uint16_t> no_depth{no_depth_row_.data(), intrinsics_.width(),
                                                intrinsics_.height(), 0};
  const LabelView labels = classifier_.classify(
      virtual_depth, is_empty(measured) ? DepthView(no_depth) : measured, known);
  return uncovered_ ? uncovered_->mark(labels) : labels;
}

}  // namespace penumbra
