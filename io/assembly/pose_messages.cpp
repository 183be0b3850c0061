// SPDX-License-Identifier: Apache-2.0
#include <io/assembly/pose_messages.hpp>

namespace penumbra::io {

PoseHistoryOptions history_options(bool compare_sources) {
  PoseHistoryOptions options;
  options.joints.compare_sources = options.transforms.compare_sources = compare_sources;
  return options;
}

std::size_t add_to_history(const JointStateMessage& message, std::string_view source,
                           PoseHistory& history) {
  return history.add_joints(message.header.stamp, message.names, message.positions, source);
}

void add_to_history(const TfMessage& message, bool is_static, std::string_view source,
                    PoseHistory& history) {
  for (const TransformMessage& t : message.transforms) {
    if (is_static)
      history.add_static_transform(t.header.frame_id, t.child_frame_id, t.T_parent_child);
    else
      history.add_transform(t.header.stamp, t.header.frame_id, t.child_frame_id, t.T_parent_child,
                            source);
  }
}

std::vector<std::string> refusals_of(const PoseHistory& history) {
  std::vector<std::string> lines;
  if (history.clock_jumps() > 0) lines.push_back(history.last_jump());
  if (history.joint_states_without_stamp() > 0)
    lines.push_back(std::to_string(history.joint_states_without_stamp()) +
                    " joint states without a stamp are not used");
  if (const std::size_t refused = history.joints().refused_values(); refused > 0)
    lines.push_back("joint positions not used: " + std::to_string(refused) +
                    " (absent, not finite, beyond 1e9, or of a quaternion not of length 1)");
  if (history.transforms().refused() > 0)
    lines.push_back("transforms are not used, the last: " + history.transforms().last_refusal());
  return lines;
}

}  // namespace penumbra::io
