// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/source_tracks.hpp>
#include <penumbra/time/transform_buffer.hpp>

namespace penumbra {

struct JointBufferOptions {
  double max_gap = 0.2;   ///< seconds between two states of a joint that may be interpolated
  double history = 10.0;  ///< seconds of states that are kept behind the newest
  std::size_t max_states = 100'000;  ///< of each variable; the oldest are dropped beyond
  bool compare_sources = true;       ///< else what other sources publish is ignored
};

enum class JointStatus { ok, missing, stale, disputed };

/// A variable that has no position at the stamp that was asked for.
struct JointGap {
  std::size_t variable = 0;                ///< index into Robot::variables()
  JointStatus why = JointStatus::missing;  ///< missing: never seen; stale: no state near the stamp
  std::optional<std::int64_t> last_seen;   ///< stamp of its latest state at or before, nanoseconds
  std::optional<double> jump;  ///< rad or m between the states next to the stamp, if too much
  std::string source;          ///< the source that is believed, where there are several
};

/// A variable for which two sources published different values near the stamp asked for.
struct JointDispute {
  std::size_t variable = 0;            ///< index into Robot::variables()
  std::int64_t stamp = 0;              ///< of the values, nanoseconds
  std::array<std::string, 2> sources;  ///< as given to insert(): the believed one, another one
  std::array<double, 2> values{};
};

struct JointAnswer {
  /// Missing before stale before disputed, where several occur.
  JointStatus status = JointStatus::missing;
  /// Order of Robot::variables(); valid only if status is ok or disputed.
  std::vector<double> positions;
  std::int64_t age = 0;                ///< nanoseconds from the stamp to the farthest used state
  std::vector<JointGap> gaps;          ///< empty if status is ok or disputed
  std::vector<JointDispute> disputes;  ///< empty if status is ok
};

/// How a joint buffer compares and interpolates a variable's values.
struct JointRule {
  enum class Kind { linear, revolute, turning };

  static constexpr double max_turn = TransformBuffer::max_turn;

  /// What sources may differ by at rest: encoders, backlash, digits. An arc of 5 mm at half a
  /// metre, which joint states and TF may differ by, too.
  static constexpr double turn_noise = 0.01;           ///< radians
  static constexpr double shift_noise = 0.005;         ///< metres
  static constexpr bool one_value_of_a_stamp = false;  ///< the last one counts

  Kind kind = Kind::linear;
  double velocity = std::numeric_limits<double>::infinity();  ///< limit, rad/s or m/s

  /// From one value to another; for turning joints by the shorter turn.
  [[nodiscard]] double difference(double from, double to) const;
  [[nodiscard]] double distance(double a, double b) const;
  [[nodiscard]] double interpolate(double a, double share, double b) const {
    return a + share * difference(a, b);
  }
  [[nodiscard]] double noise() const;
  /// The largest distance of two states that are `seconds` apart.
  [[nodiscard]] double largest_step(double seconds) const;
};

/// Likewise of the rotation of a floating joint.
struct RotationRule {
  static constexpr bool one_value_of_a_stamp = false;

  [[nodiscard]] double distance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) const {
    return a.angularDistance(b);
  }
  [[nodiscard]] Eigen::Quaterniond interpolate(const Eigen::Quaterniond& a, double share,
                                               const Eigen::Quaterniond& b) const {
    return a.slerp(share, b);
  }
  [[nodiscard]] double noise() const { return JointRule::turn_noise; }
};

/// Merges joint states (complete or partial, in any order of names and time) and interpolates them
/// to a stamp. Never extrapolates: a stamp that is not between two states of a joint no more than
/// max_gap apart (or on one) is answered "stale".
///
/// Values are interpolated linearly, continuous joints and the yaw of planar ones the short way
/// round. The quaternion of a floating joint is interpolated on the sphere; its parts may come in
/// several consecutive states of one stamp and source. A joint that jumps is "stale" between the
/// two states: by more than a right angle, or than the velocity limit of the URDF allows in their
/// time. Encoders wrap, and values may be wrong.
///
/// Where several sources publish a variable, one of them is believed and the others are compared
/// with it: see SourceTracks. Near a stamp where they disagree the variable is "disputed".
class JointBuffer {
 public:
  /// Throws InputError for options that are negative, not finite or above 1e9 s, and max_states 0.
  explicit JointBuffer(const Robot& robot, JointBufferOptions options = {});

  /// Adds one joint state. Names that are no variable of the robot (mimicking joints, other
  /// devices) are skipped; names without a position, values that are not finite or lie
  /// beyond +-1e9, and quaternions whose length is off 1 by more than 1 % are refused and counted.
  /// A second value of a source for one joint and stamp replaces the first. Returns the number of
  /// values taken. `source`: a name of the publisher, the same for all of its states.
  std::size_t insert(std::int64_t stamp, std::span<const std::string> names,
                     std::span<const double> positions, std::string_view source = {});

  /// Positions at `stamp`. Allocates only until the answer's vectors have their size.
  void at(std::int64_t stamp, JointAnswer& answer) const;

  /// Stamp of the newest state up to which every joint is known; nothing before that, and for a
  /// robot without variables.
  [[nodiscard]] std::optional<std::int64_t> complete_until() const;

  /// Stamp of the newest state of any of the variables named.
  [[nodiscard]] std::optional<std::int64_t> newest_of(std::span<const std::string> names) const;

  /// Forgets every state, as after a jump of the clock; the counts stay.
  void clear();

  /// Positions of the robot's joints that insert() did not take.
  [[nodiscard]] std::size_t refused_values() const { return refused_values_; }

 private:
  using Track = SourceTracks<double, JointRule>;
  using RotationTrack = SourceTracks<Eigen::Quaterniond, RotationRule>;

  /// The rotation of a floating joint.
  struct Rotation {
    std::size_t first;  // of its four variables: x, y, z, w
    RotationTrack track;
    // What is known of the newest one:
    std::int64_t stamp = 0;
    std::string source = {};
    std::array<bool, 4> known{};
    Eigen::Vector4d xyzw = Eigen::Vector4d::Zero();
  };

  void set_part(Rotation& rotation, std::size_t part, std::int64_t stamp, std::string_view source,
                double value);
  [[nodiscard]] std::size_t take_rotations(std::int64_t stamp, std::string_view source);
  [[nodiscard]] bool interpolate(std::size_t variable, std::int64_t stamp,
                                 JointAnswer& answer) const;
  [[nodiscard]] bool interpolate(const Rotation& rotation, std::int64_t stamp,
                                 JointAnswer& answer) const;
  template <typename AnyTrack, typename Rule>
  [[nodiscard]] JointGap gap_of(const AnyTrack& track, const Rule& rule, std::int64_t stamp) const;
  template <typename Found>
  [[nodiscard]] JointDispute dispute_of(const Found& found) const;
  void add_disputes(std::int64_t stamp, JointAnswer& answer) const;
  void prune();

  std::int64_t max_gap_;  // nanoseconds
  std::int64_t history_;  // nanoseconds
  std::size_t max_states_;
  std::map<std::string, std::size_t, std::less<>> index_;  // variable of each name
  std::vector<Track> tracks_;                              // of each variable but rotations' parts
  std::vector<JointRule> rules_;                           // of each variable
  std::vector<Rotation> rotations_;
  std::vector<std::optional<std::size_t>> rotation_of_;  // of each variable that is a part of one
  std::optional<std::int64_t> newest_;
  std::size_t refused_values_ = 0;
};

}  // namespace penumbra
