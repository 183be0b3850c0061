// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <utility>

#include <io/files/picture.hpp>
#include <io/web/pose_outlines.hpp>

namespace penumbra::io {

std::optional<PartBytes> PoseOutlines::draw(const RobotPose& pose, const CalibrationProgress& of) {
  if (!of.is_ready() || (pose.positions.empty() && pose.T_root_link.empty())) return std::nullopt;
  const std::lock_guard lock(mutex_);
  if (!pipeline_ || camera_.parent != of.camera_parent) {
    camera_.parent = of.camera_parent;
    camera_.T_parent_camera = of.found->T_parent_camera;
    PipelineConfig config;
    config.has_depth = false;
    pipeline_.emplace(robot_, camera_, config);
  }
  Image<std::uint8_t> image(camera_.intrinsics.width(), camera_.intrinsics.height());
  const auto draw_from = [&](const Eigen::Isometry3d& T_parent_camera, std::uint8_t value) {
    Frame frame;
    frame.pose = pose;
    frame.pose.status = FrameStatus::ok;
    frame.pose.message.clear();
    frame.pose.T_parent_camera = T_parent_camera;
    const FrameReport& report = pipeline_->process(frame);
    if (!report.virtual_depth.depth.empty()) draw_outline(report.virtual_depth.depth, value, image);
  };
  if (of.given) draw_from(*of.given, 1);
  draw_from(of.found->T_parent_camera, 2);
  return PartBytes{"u8", image.width(), image.height(),
                   shared_bytes({reinterpret_cast<const char*>(image.data()), image.size()})};
}

}  // namespace penumbra::io
