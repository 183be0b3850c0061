// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/transform_buffer.hpp>

namespace penumbra {

struct JointBufferOptions {
  double max_gap = 0.2;   ///< seconds between two states of a joint that may be interpolated
  double history = 10.0;  ///< seconds of states that are kept behind the newest
  std::size_t max_states = 100'000;  ///< per variable; the oldest are dropped
  bool compare_sources = true;       ///< false: other sources are ignored
};

enum class JointStatus { ok, missing, stale, disputed };

/// A variable without a position at the requested stamp.
struct JointGap {
  std::size_t variable = 0;                ///< index into Robot::variables()
  JointStatus why = JointStatus::missing;  ///< missing: never seen; stale: no state near the stamp
  std::optional<std::int64_t> last_seen =
      {};  ///< stamp of its last state up to the stamp, nanoseconds
  std::optional<std::int64_t> next_seen = {};  ///< of its first state after the stamp
  std::optional<double> jump = {};  ///< rad or m between the neighbouring states, if too large
  std::string source = {};          ///< the believed source, if there are several
  bool is_refused = false;          ///< never seen, but for values that are not finite or too large
};

/// A variable for which two sources published different values near the requested stamp.
struct JointDispute {
  std::size_t variable = 0;            ///< index into Robot::variables()
  std::int64_t stamp = 0;              ///< of the values, nanoseconds
  std::array<std::string, 2> sources;  ///< as given to insert(): the believed one and another one
  std::array<double, 2> values{};
};

struct JointAnswer {
  /// The first that applies of missing, stale and disputed.
  JointStatus status = JointStatus::missing;
  /// Order of Robot::variables(); valid only if status is ok or disputed.
  std::vector<double> positions;
  std::int64_t age = 0;                ///< nanoseconds from the stamp to the farthest used state
  std::vector<JointGap> gaps;          ///< empty if status is ok or disputed
  std::vector<JointDispute> disputes;  ///< empty if status is ok
  std::int64_t stamp = 0;              ///< for which it is, nanoseconds
  /// Names in the states that are no joints of the robot, at most 100. Empty if no variable is
  /// missing.
  std::vector<std::string> other_names = {};
};

template <typename T, typename Rule>
class SourceTracks;

/// How a joint buffer compares and interpolates a variable's values.
struct JointRule {
  enum class Kind { linear, revolute, turning };

  static constexpr double max_turn = TransformBuffer::max_turn;

  /// Accepted difference of sources at rest: encoders, backlash, rounding. The arc is 5 mm at half
  /// a metre, as for joint states and TF.
  static constexpr double turn_noise = 0.01;           ///< radians
  static constexpr double shift_noise = 0.005;         ///< metres
  static constexpr bool one_value_of_a_stamp = false;  ///< the last value of a stamp counts

  Kind kind = Kind::linear;
  double velocity = std::numeric_limits<double>::infinity();  ///< limit, rad/s or m/s

  /// Returns to - from; for turning joints by the shorter way.
  [[nodiscard]] double difference(double from, double to) const;
  [[nodiscard]] double distance(double a, double b) const;
  [[nodiscard]] double interpolate(double a, double fraction, double b) const {
    return a + fraction * difference(a, b);
  }
  [[nodiscard]] double noise() const;
  /// Returns the largest possible distance of two states `seconds` apart.
  [[nodiscard]] double largest_step(double seconds) const;
};

/// Merges joint states (complete or partial, in any order of names and time) and interpolates them
/// at a stamp. Never extrapolates: a joint is stale at a stamp that is neither that of a state nor
/// between two states at most max_gap apart.
///
/// Values are interpolated linearly; continuous joints and the yaw of planar joints by the shorter
/// way. The quaternion of a floating joint is interpolated by slerp; its parts may come in several
/// consecutive states of one stamp and source. A joint is also stale between two states that differ
/// by more than a right angle or than the URDF's velocity limit allows: an encoder wrapped, or a
/// value is wrong.
///
/// If several sources publish a variable, one is believed and the others are compared with it: see
/// SourceTracks. The variable is disputed near a stamp where they disagree.
class JointBuffer {
 public:
  /// Throws InputError for options that are negative, not finite or above 1e9 s, and max_states 0.
  explicit JointBuffer(const Robot& robot, JointBufferOptions options = {});
  ~JointBuffer();
  JointBuffer(JointBuffer&&) noexcept;
  JointBuffer& operator=(JointBuffer&&) noexcept;

  /// Adds one joint state and returns the number of accepted values. Skips names that are not
  /// variables of the robot (mimic joints, other devices). Refuses and counts names without a
  /// position, all if there are more positions than names, values that are not finite or beyond
  /// +-1e9, and quaternions whose length differs from 1 by more than 1 %. A second value of one
  /// source, joint and stamp replaces the first, but one in the same state disputes it. `source`: a
  /// name of the publisher, the same for all its states.
  std::size_t insert(std::int64_t stamp, std::span<const std::string> names,
                     std::span<const double> positions, std::string_view source = {});

  /// Writes the positions at `stamp`. Allocates only until the answer's vectors have their size.
  void at(std::int64_t stamp, JointAnswer& answer) const;

  /// Returns the newest stamp at which every joint is known; null if there is none, and for a robot
  /// without variables.
  [[nodiscard]] std::optional<std::int64_t> complete_until() const;

  /// Returns the newest stamp of the named variables.
  [[nodiscard]] std::optional<std::int64_t> newest_of(std::span<const std::string> names) const;

  /// Removes all states, as after a jump of the clock. Keeps the counts.
  void clear();

  /// Returns the number of values that insert() refused.
  [[nodiscard]] std::size_t refused_values() const { return refused_values_; }

 private:
  using Track = SourceTracks<double, JointRule>;
  struct Rotation;

  void note_other(const std::string& name);
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
  std::vector<bool> is_refused_;           // of each variable: a value of it was refused
  std::vector<std::uint64_t> last_state_;  // of each variable: number of the state that had it
  std::uint64_t states_ = 0;
  std::set<std::string, std::less<>> other_joints_;  // of the robot: without a variable
  std::vector<std::string> other_names_;             // of no joint
};

}  // namespace penumbra
