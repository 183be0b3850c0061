// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <io/files/image_size.hpp>
#include <io/files/overlay.hpp>
#include <io/files/overlay_painter.hpp>

namespace penumbra::io {
namespace {

LabelView labels_of(const FrameReport& report) {
  const PixelCounts& pixels = report.pixels;
  const std::size_t all = static_cast<std::size_t>(report.labels.width) *
                          static_cast<std::size_t>(report.labels.height);
  const std::size_t labelled =
      pixels.front + pixels.occluded + pixels.unknown + pixels.beyond + pixels.fringe;
  return {report.labels,
          {all - labelled - pixels.uncovered, pixels.front, pixels.occluded, pixels.unknown,
           pixels.beyond, pixels.fringe},
          nullptr};
}

}  // namespace

ImageView<const Rgb8> OverlayPainter::draw(const FrameReport& report, const ShownImages& images,
                                           const ShownTargets& targets) {
  OverlayInput input;
  input.labels = labels_of(report);
  input.uncovered = report.pixels.uncovered;
  input.index = static_cast<std::int64_t>(report.index);
  input.stamp = report.stamp;
  input.message = report.message;
  input.pose_known = has_pose(report.status);
  if (!images.color.empty()) {
    input.color = seen_color(images.color);
  } else {
    std::visit(
        [&](const auto& depth) { input.depth = rectified(rectification_, depth, depth_of(depth)); },
        images.depth);
  }
  draw_overlay(input, overlay_);
  target_overlay_.draw(targets.targets, report, targets.robot, targets.camera, overlay_);
  return std::as_const(overlay_).view();
}

ImageView<const Rgb8> OverlayPainter::seen_color(ImageView<const Rgb8> raw) {
  return rectified(rectification_, raw, color_);
}

}  // namespace penumbra::io
