// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>

namespace penumbra {

struct JointBufferOptions {
  double max_gap = 0.2;   ///< seconds between two states of a joint that may be interpolated
  double history = 10.0;  ///< seconds of states that are kept behind the newest
};

enum class JointStatus { ok, missing, stale };

/// A variable that has no position at the stamp that was asked for.
struct JointGap {
  std::size_t variable = 0;                ///< index into Robot::variables()
  JointStatus why = JointStatus::missing;  ///< missing: never seen; stale: no state near the stamp
  std::optional<std::int64_t> last_seen;   ///< stamp of its latest state at or before, nanoseconds
};

struct JointAnswer {
  JointStatus status = JointStatus::missing;  ///< missing before stale, where both occur
  std::vector<double> positions;  ///< order of Robot::variables(); valid only if status is ok
  std::int64_t age = 0;           ///< nanoseconds from the stamp to the farthest used state
  std::vector<JointGap> gaps;     ///< empty if status is ok
};

/// Merges joint states (complete or partial, in any order of names and time) and interpolates them
/// to a stamp. Never extrapolates: a stamp that is not between two states of a joint no more than
/// max_gap apart (or on one) is answered "stale".
class JointBuffer {
 public:
  explicit JointBuffer(const Robot& robot, JointBufferOptions options = {});

  /// Adds one joint state. Names that are no variable of the robot (mimicking joints, other
  /// devices) are skipped and counted; values that are not finite are refused and counted. A second
  /// value for one joint and stamp replaces the first. Returns the number of values taken.
  std::size_t insert(std::int64_t stamp, std::span<const std::string> names,
                     std::span<const double> positions);

  /// Positions at `stamp`. Allocates only until the answer's vectors have their size.
  void at(std::int64_t stamp, JointAnswer& answer) const;

  /// Stamp of the newest state up to which every joint is known; nothing before that.
  [[nodiscard]] std::optional<std::int64_t> complete_until() const;

  [[nodiscard]] std::size_t skipped_names() const { return skipped_names_; }
  [[nodiscard]] std::size_t refused_values() const { return refused_values_; }

 private:
  struct State {
    std::int64_t stamp;
    double value;
  };
  JointBufferOptions options_;
  std::vector<std::vector<State>> states_;  // one sorted history per variable
  std::size_t skipped_names_ = 0;
  std::size_t refused_values_ = 0;
};

}  // namespace penumbra
