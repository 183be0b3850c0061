// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>

#include <io/files/overlay_painter.hpp>
#include <io/files/picture.hpp>
#include <io/web/calibration_pictures.hpp>

namespace penumbra::io {
namespace {

constexpr float full_color = 0.02F;  // metres of distance that have the full colour
constexpr float farthest = 0.1F;     // metres: what is farther off is not the robot
constexpr Rgb8 outline_color{0, 220, 80}, guess_color{230, 0, 0}, mask_color{160, 160, 160};
constexpr std::size_t most_frames = 10;

/// Blue where the measured point is before the robot's surface, red where it is behind.
Rgb8 distance_color(float metres) {
  const auto pale = static_cast<std::uint8_t>(
      std::lround(255.0F * (1.0F - std::min(1.0F, std::abs(metres) / full_color))));
  return metres < 0.0F ? Rgb8{pale, pale, 255} : Rgb8{255, pale, pale};
}

class FramePainter {
 public:
  FramePainter(const Intrinsics& camera, const Robot& robot, const std::string& parent)
      : parent_(parent.empty() ? 0 : robot.find_link(parent).value()),
        renderer_(make_depth_renderer(Backend::cpu, camera, bodies_of(robot))) {}

  /// Returns the frame's depth or colour image with the robot at this camera pose.
  ImageView<const Rgb8> draw(const KeptFrame& frame, const Calibration& found,
                             const Eigen::Isometry3d& T_parent_camera, const Rgb8& outline) {
    FrameReport report;
    report.index = frame.index;
    const bool has_depth = !frame.depth.empty();
    if (has_depth)
      draw_overlay(report, {frame.depth.view(), {}}, image_);
    else if (!frame.color.empty())
      image_ = frame.color;
    else
      image_ = Image<Rgb8>(frame.mask.width(), frame.mask.height());
    std::vector<Eigen::Isometry3d> poses = frame.T_root_link;
    const Eigen::Isometry3d T_camera_root = (poses[parent_] * T_parent_camera).inverse();
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    const ImageView<const float> robot = renderer_->render(poses).depth;
    for (int v = 0; v < robot.height; ++v)
      for (int u = 0; u < robot.width; ++u) {
        if (!has_depth) {
          if (frame.color.empty() && frame.mask(u, v) != 0) image_(u, v) = mask_color;
          continue;
        }
        const float distance = (frame.depth(u, v) - static_cast<float>(found.depth_offset->value)) /
                                   (1.0F + static_cast<float>(found.depth_scale->value)) -
                               robot(u, v);
        if (robot(u, v) > 0.0F && frame.depth(u, v) > 0.0F && std::abs(distance) < farthest)
          image_(u, v) = distance_color(distance);
      }
    draw_outline(robot, outline, image_);
    return std::as_const(image_).view();
  }

 private:
  std::size_t parent_;
  std::unique_ptr<DepthRenderer> renderer_;
  Image<Rgb8> image_;
};

}  // namespace

std::vector<PagePicture> calibration_pictures(std::span<const KeptFrame> frames,
                                              const Intrinsics& camera, const Robot& robot,
                                              const CalibrationOptions& options,
                                              const Calibration& found) {
  FramePainter painter(camera, robot, options.camera_parent);
  std::vector<PagePicture> pictures;
  for (const KeptFrame& frame : frames.first(std::min(frames.size(), most_frames))) {
    const std::string name = "frame " + std::to_string(frame.index);
    if (options.initial)
      pictures.push_back(
          {frame.index,
           picture_uri(painter.draw(frame, found, *options.initial,
                                    frame.color.empty() ? outline_color : guess_color)),
           name + ", first guess"});
    pictures.push_back(
        {frame.index, picture_uri(painter.draw(frame, found, found.T_parent_camera, outline_color)),
         name + ", result"});
  }
  return pictures;
}

}  // namespace penumbra::io
