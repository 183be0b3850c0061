// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <Eigen/Geometry>

#include <penumbra/base/recent_values.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// A verdict, and whether estimates of its stamp are accepted at all.
struct RecentVerdict {
  Verdict verdict = Verdict::unknown;
  bool is_reliable =
      false;          ///< false: the robot or depth was not fully known, or nothing was judged
  double seen = 0.0;  ///< fraction of the target
};

/// Follows a target with the tracker of its handling. Poses are in the root link's frame.
class TargetTrack {
 public:
  /// `handling` is not std::monostate. Throws InputError for an invalid configuration.
  explicit TargetTrack(const TargetHandling& handling);

  /// Notes the verdict of a stamp; estimates of that stamp are accepted by it.
  void add(std::int64_t stamp, const RecentVerdict& verdict) { verdicts_.at(stamp) = verdict; }

  /// Returns the verdict of exactly that stamp if it is reliable, else null.
  [[nodiscard]] const RecentVerdict* reliable_verdict(std::int64_t stamp);

  /// Takes an estimate given in a frame whose pose is T_root_frame. Throws as check_estimate().
  Outcome update(std::int64_t stamp, const TargetEstimate& estimate, const RecentVerdict& verdict,
                 const Eigen::Isometry3d& T_root_frame);

  /// Forgets all estimates and starts from the pose of the body that carries the target at a stamp.
  /// Returns the target there.
  HandledTarget carry(std::int64_t stamp, const Eigen::Isometry3d& T_root_target);

  /// Returns the target at a stamp. `is_measured`: an estimate of this frame was accepted; else the
  /// source is never `measured`, even if an earlier estimate has the same stamp.
  [[nodiscard]] HandledTarget at(std::int64_t stamp, bool is_measured) const;

 private:
  std::variant<std::monostate, PoseTracker, PointTracker> tracker_;
  Source unmeasured_ = Source::predicted;  ///< the source if it is neither measured nor lost
  RecentValues<RecentVerdict> verdicts_;
};

}  // namespace penumbra
