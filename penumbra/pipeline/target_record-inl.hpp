// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <penumbra/pipeline/target.hpp>

namespace penumbra {

/// A verdict and whether estimates of its stamp may be taken at all.
struct StampedVerdict {
  std::int64_t stamp = 0;
  Verdict verdict = Verdict::unknown;
  bool was_judged = false;  ///< false: robot or depth were not wholly known, or the target refused
  double seen = 0.0;        ///< share of the target
};

/// The last verdicts of a target.
class VerdictLog {
 public:
  static constexpr std::size_t verdicts = 128;

  void add(const StampedVerdict& verdict);  ///< in place of one of the same stamp
  [[nodiscard]] std::optional<StampedVerdict> find(std::int64_t stamp) const;

 private:
  std::vector<StampedVerdict> entries_;
  std::size_t next_ = 0;
};

/// Follows a target by whichever tracker its handling asks for. Poses in the root link's frame.
class TargetTrack {
 public:
  /// Throws InputError for a configuration that is at fault.
  explicit TargetTrack(const TargetHandling& handling);

  [[nodiscard]] bool handles() const { return tracker_.index() != 0; }

  /// An estimate of a verdict's stamp, in a frame whose pose is T_root_frame.
  Outcome update(const TargetEstimate& estimate, const StampedVerdict& verdict,
                 const Eigen::Isometry3d& T_root_frame);

  /// Nothing where the target is not handled. `is_measured`: an estimate of this frame was taken;
  /// else nothing is `measured`, not even by another one of the same stamp.
  [[nodiscard]] std::optional<HandledTarget> at(std::int64_t stamp, bool is_measured) const;

 private:
  std::variant<std::monostate, PoseTracker, PointTracker> tracker_;
  Source carried_ = Source::predicted;  ///< what a target is that is not measured, nor lost
};

/// What is remembered of a target from frame to frame.
struct TargetRecord {
  std::size_t call = 0;                    ///< in which it was given last
  std::size_t times = 0;                   ///< that it was given in that call
  std::optional<std::int64_t> last_stamp;  ///< that it was judged at
  std::optional<TargetTrack> track;        ///< nothing before the first, and if refused
  VerdictLog log;
  std::optional<Eigen::Vector2d> good_pixel;  ///< where the track was seen when last visible
};

}  // namespace penumbra
