// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/live/live_fusion.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

std::vector<ViewCamera> cameras_of(const std::vector<std::string>& names) {
  // Frames come as views, which are made with the intrinsics of their setup.
  const Intrinsics any(1, 1, 1.0, 1.0, 0.0, 0.0);
  std::vector<ViewCamera> cameras;
  for (const std::string& name : names) cameras.push_back({name, any, {}});
  return cameras;
}

}  // namespace

LiveFusion::LiveFusion(const std::vector<std::string>& cameras,
                       std::function<void(std::span<const std::byte>)> publish)
    : fusion_(cameras_of(cameras)), publish_(std::move(publish)) {}

void LiveFusion::add(std::size_t camera, const CameraFrame& frame, const std::string& root) {
  const std::lock_guard lock(mutex_);
  fusion_.add(camera, frame);
  TargetViewsMessage message{.header = {frame.stamp, root}};
  for (const auto& [name, view] : frame.views)
    message.targets.push_back(target_view_message(fusion_.fused(name), fusion_.cameras()));
  encode(message, payload_);
  publish_(payload_);
}

void LiveFusion::add_contradictions(DiagnosticArrayMessage& message) {
  const std::lock_guard lock(mutex_);
  DiagnosticStatusMessage& robot = message.status.front();
  for (const FusedTarget& target : fusion_.fused()) {
    if (!target.contradiction) continue;
    const std::string line = "target '" + target.name + "': " + target.reason;
    if (robot.level == DiagnosticStatusMessage::ok) {
      robot.level = DiagnosticStatusMessage::warn;
      robot.message = line;
    }
    robot.values.push_back({"contradiction", line});
  }
}

}  // namespace penumbra::io
