// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

std::string_view to_string(FrameStatus status) {
  constexpr std::array<std::string_view, 9> names = {
      "ok",        "missing_joints",    "stale_joints",    "missing_link",  "missing_depth",
      "bad_depth", "missing_transform", "stale_transform", "poses_disagree"};
  return names[static_cast<std::size_t>(status)];
}

bool has_pose(FrameStatus status) {
  return status != FrameStatus::missing_joints && status != FrameStatus::stale_joints &&
         status != FrameStatus::missing_transform && status != FrameStatus::stale_transform &&
         status != FrameStatus::poses_disagree;
}

JointInput::JointInput(const JointAnswer& answer)
    : positions(answer.positions),
      status(answer.status),
      gaps(answer.gaps),
      disputes(answer.disputes) {
  if (answer.status == JointStatus::ok) age = answer.age;
}

}  // namespace penumbra
