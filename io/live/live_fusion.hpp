// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/fusion/target_fusion.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The topic's name follows "/penumbra/".
inline constexpr std::string_view target_views_topic = "target_views";
inline constexpr std::string_view target_views_type = "penumbra_msgs/msg/TargetViews";

/// Publishes the verdicts over all cameras after each frame. Any thread may call this.
class LiveFusion {
 public:
  /// `publish`: takes a message in CDR, valid during the call. Throws InputError like TargetFusion.
  LiveFusion(const std::vector<std::string>& cameras,
             std::function<void(std::span<const std::byte>)> publish);

  /// `root`: the robot's root link.
  void add(std::size_t camera, const CameraFrame& frame, const std::string& root);

  /// Adds to the robot's status, the first one, which targets are unknown because cameras measure
  /// them at different places.
  void add_contradictions(DiagnosticArrayMessage& message);

 private:
  std::mutex mutex_;
  TargetFusion fusion_;
  std::function<void(std::span<const std::byte>)> publish_;
  std::vector<std::byte> payload_;
};

}  // namespace penumbra::io
