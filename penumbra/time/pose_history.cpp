// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

PoseHistory::PoseHistory(const Robot& robot, const PoseHistoryOptions& options)
    : joints_(robot, options.joints), transforms_(options.transforms) {}

std::size_t PoseHistory::add_joints(std::int64_t stamp, std::span<const std::string> names,
                                    std::span<const double> positions, std::string_view source) {
  if (stamp <= 0) {
    ++no_stamps_;
    return 0;
  }
  const auto newest = joints_.newest_of(names);
  ++revision_;
  const std::size_t taken = joints_.insert(stamp, names, positions, source);
  // One that is refused, as of values that are not finite, says nothing of the clock.
  if (taken == 0 || !newest || !note_stamp(stamp, *newest, "joint states")) return taken;
  return joints_.insert(stamp, names, positions, source);
}

TransformInsert PoseHistory::add_transform(std::int64_t stamp, std::string_view parent,
                                           std::string_view child,
                                           const Eigen::Isometry3d& T_parent_child,
                                           std::string_view source) {
  const auto newest = transforms_.newest_of(child);
  ++revision_;
  const TransformInsert outcome = transforms_.insert(stamp, parent, child, T_parent_child, source);
  // One that is refused, as of a second parent, says nothing of the clock.
  if (outcome != TransformInsert::taken || !newest || !note_stamp(stamp, *newest, "transforms"))
    return outcome;
  return transforms_.insert(stamp, parent, child, T_parent_child, source);
}

TransformInsert PoseHistory::add_static_transform(std::string_view parent, std::string_view child,
                                                  const Eigen::Isometry3d& T_parent_child) {
  ++revision_;
  return transforms_.insert_static(parent, child, T_parent_child);
}

bool PoseHistory::note_stamp(std::int64_t stamp, std::int64_t newest, std::string_view of) {
  if (!is_clock_jump(stamp, newest)) return false;
  ++clock_jumps_;
  last_jump_ = "the clock jumped back by " +
               std::to_string(stamp_distance(stamp, newest) / 1'000'000) + " ms: stamp " +
               std::to_string(stamp) + " ns of " + std::string(of) + " follows " +
               std::to_string(newest) +
               " ns; joint states, transforms and waiting frames are "
               "dropped";
  clear();
  return true;
}

void PoseHistory::clear() {
  joints_.clear();
  transforms_.clear();
  attachments_.restart();
  ++epoch_;
  ++revision_;
}

}  // namespace penumbra
