// SPDX-License-Identifier: Apache-2.0
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

std::string_view to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::ok:
      return "ok";
    case FrameStatus::missing_joints:
      return "missing_joints";
    case FrameStatus::stale_joints:
      return "stale_joints";
    case FrameStatus::missing_link:
      return "missing_link";
    case FrameStatus::missing_depth:
      return "missing_depth";
    case FrameStatus::bad_depth:
      return "bad_depth";
    case FrameStatus::missing_transform:
      return "missing_transform";
    case FrameStatus::stale_transform:
      return "stale_transform";
    case FrameStatus::poses_disagree:
      return "poses_disagree";
  }
  return "";
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
