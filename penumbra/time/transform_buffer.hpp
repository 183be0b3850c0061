// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace penumbra {

struct TransformBufferOptions {
  double max_gap = 0.2;   ///< seconds between two states of a frame that may be interpolated
  double history = 10.0;  ///< seconds of states that are kept behind the newest of each frame
  std::size_t max_states = 100'000;  ///< per frame; the oldest are dropped
  std::size_t max_frames = 4096;     ///< further frames are refused
  std::size_t max_depth = 128;       ///< transforms of a chain; longer chains are missing
  bool compare_sources = true;       ///< false: other sources are ignored
};

/// The result of inserting a transform.
enum class TransformInsert {
  taken,
  bad_name,         ///< empty, or longer than max_name_length
  no_stamp,         ///< a stamp of 0 or negative
  not_rigid,        ///< not finite, not a rotation, or farther than 1e9 m
  loop,             ///< the parent is the child or one of its descendants
  second_parent,    ///< the child has another parent
  static_and_free,  ///< the child was published as static and as moving
  too_many_frames,
};
inline constexpr std::size_t transform_inserts = 8;

enum class TransformStatus { ok, missing, stale, disputed };

struct TransformAnswer {
  TransformStatus status = TransformStatus::missing;
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();  ///< valid only if ok
  std::int64_t age = 0;    ///< nanoseconds from the stamp to the farthest used state
  bool is_static = false;  ///< composed of static transforms only
  std::string message;     ///< one line that names the frames; empty if ok
};

/// Poses of frames in their parents over time, as in TF, and the transform between any two frames
/// at a stamp. Never extrapolates: a moving frame is stale at a stamp that is neither that of a
/// state nor between two states at most max_gap apart, and between two states that differ by more
/// than a right angle.
///
/// Origins are interpolated linearly, rotations by slerp. That is exact for a frame moved by one
/// joint at constant speed, and agrees with JointBuffer for a floating joint.
///
/// If several sources publish a moving frame, one is believed and the others are compared with it:
/// see SourceTracks. Two poses of one source and stamp are compared as well, because a bag does not
/// store the publisher. The frame is disputed near a stamp where they disagree.
///
/// Frame names lose one leading "/". Each frame keeps its first parent until clear().
class TransformBuffer {
 public:
  static constexpr std::size_t max_name_length = 256;
  static constexpr double max_translation = 1e9;   ///< metres
  static constexpr double max_turn = 1.570796327;  ///< radians between two states: a right angle

  /// Throws InputError for times that are negative, not finite or above 1e9 s, and limits of 0.
  explicit TransformBuffer(const TransformBufferOptions& options = {});
  ~TransformBuffer();
  TransformBuffer(TransformBuffer&&) noexcept;
  TransformBuffer& operator=(TransformBuffer&&) noexcept;

  /// Adds one pose of `child`; replaces one of the same stamp and source. A refused pose is counted
  /// and changes nothing. `source`: a name of the publisher.
  TransformInsert insert(std::int64_t stamp, std::string_view parent, std::string_view child,
                         const Eigen::Isometry3d& T_parent_child, std::string_view source = {});

  /// Adds a pose for all stamps; replaces an earlier one.
  TransformInsert insert_static(std::string_view parent, std::string_view child,
                                const Eigen::Isometry3d& T_parent_child);

  /// Writes the pose of `source` in `target` at `stamp`. Reports the first fault on the path up
  /// from `source`, then on the path up from `target`. Allocates nothing for an answer that is ok,
  /// once the answer has been used.
  void at(std::int64_t stamp, std::string_view target, std::string_view source,
          TransformAnswer& answer) const;

  /// Returns whether the frame was ever named.
  [[nodiscard]] bool knows(std::string_view frame) const;

  /// Returns the newest stamp of a moving frame.
  [[nodiscard]] std::optional<std::int64_t> newest_of(std::string_view child) const;

  /// Removes moving frames, as after a jump of the clock. Keeps static frames and the counts.
  void clear();

  /// Returns the number of transforms with this result.
  [[nodiscard]] std::size_t count(TransformInsert outcome) const;
  [[nodiscard]] std::size_t refused() const;  ///< all except `taken`
  /// One line about the last refused transform; empty if there was none.
  [[nodiscard]] const std::string& last_refusal() const { return last_refusal_; }

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  struct Pose;
  struct PoseRule;
  struct FrameNode;
  /// Two frames and their nearest common ancestor.
  struct Chain {
    std::size_t target = none, source = none, meeting = none;
    std::size_t target_depth = 0, source_depth = 0;  // below the meeting frame
  };

  [[nodiscard]] static Pose pose_of(const Eigen::Isometry3d& T);
  /// Returns the node of a pose, or null if it is refused.
  FrameNode* place(std::optional<std::int64_t> stamp, std::string_view parent,
                   std::string_view child, const Eigen::Isometry3d& T_parent_child,
                   TransformInsert& outcome);
  [[nodiscard]] TransformInsert judge(std::optional<std::int64_t> stamp, std::string_view parent,
                                      std::string_view child, const Eigen::Isometry3d& T) const;
  [[nodiscard]] TransformInsert judge_tree(bool is_static, std::string_view parent,
                                           std::string_view child) const;
  [[nodiscard]] std::string describe(TransformInsert why, std::string_view parent,
                                     std::string_view child) const;
  std::size_t find_or_add(std::string_view name);
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  [[nodiscard]] std::size_t depth_of(std::size_t frame) const;
  [[nodiscard]] std::optional<Chain> find_chain(std::string_view target,
                                                std::string_view source) const;
  [[nodiscard]] std::string no_chain(std::string_view target, std::string_view source) const;
  bool climb(std::size_t from, std::size_t to, std::int64_t stamp, Pose& T_to_from,
             TransformAnswer& answer) const;
  bool interpolate(const FrameNode& frame, std::int64_t stamp, Pose& pose,
                   TransformAnswer& answer) const;
  void explain_stale(const FrameNode& frame, std::int64_t stamp, TransformAnswer& answer) const;
  void explain_disputed(const FrameNode& frame, std::int64_t stamp, TransformAnswer& answer) const;

  std::int64_t max_gap_;  // nanoseconds
  std::int64_t history_;  // nanoseconds
  TransformBufferOptions options_;
  std::map<std::string, std::size_t, std::less<>> index_;  // of each name, in frames_
  std::vector<FrameNode> frames_;
  std::array<std::size_t, transform_inserts> counts_{};
  std::string last_refusal_;
};

}  // namespace penumbra
