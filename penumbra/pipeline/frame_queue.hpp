// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// Which frames are given out.
enum class DropPolicy {
  newest,  ///< the newest by stamp that can be; those before it are dropped. For live images
  every    ///< all of them, in the order they came. For bags
};

/// Why a frame was dropped.
enum class DropReason {
  superseded,  ///< a newer one was given out in its place (newest)
  late,        ///< it came when one of its stamp or after had been given out (newest)
  overflow,  ///< max_frames waited already; of `newest` the oldest goes, of `every` the one to come
  clock_jump,  ///< the clock jumped back, and it was from before
  no_stamp,    ///< its stamp is 0 or before: when it was taken is not known
  no_pose      ///< the robot's pose did not come in time (drop_without_pose)
};
inline constexpr std::size_t drop_reasons = 6;
[[nodiscard]] std::string_view to_string(DropReason reason);

struct FrameQueueOptions {
  DropPolicy policy = DropPolicy::newest;
  /// The camera's: seconds added to an image's stamp before poses are looked up; negative where
  /// images are stamped later than they are taken.
  double time_offset = 0.0;
  double max_wait = 0.2;  ///< seconds on the caller's clock that an image waits for its pose
  std::size_t max_frames =
      32;  ///< that wait at a time; the first of so many waits no longer (every)
  bool drop_without_pose = false;  ///< else frames come out with the status that says why
  PoseOptions poses = {};
};

struct DroppedFrame {
  std::uint64_t key = 0;
  std::int64_t stamp = 0;  ///< nanoseconds
  DropReason reason = DropReason::superseded;
};

/// A frame whose pose is known, or was waited for in vain.
struct QueuedFrame {
  std::uint64_t key = 0;        ///< as pushed
  std::int64_t stamp = 0;       ///< the image's own, nanoseconds
  std::int64_t pose_stamp = 0;  ///< with time_offset: what `pose` is of
  std::int64_t waited = 0;      ///< nanoseconds on the caller's clock
  PoseAnswer pose;              ///< ok, or a status without a pose

  /// All of the pipeline's input but depth and targets. Refers to this.
  [[nodiscard]] Frame frame() const;
};

/// What became of the frames: pushed = given_out + dropped + waiting.
struct FrameCounts {
  std::size_t pushed = 0;
  std::size_t given_out = 0;
  std::size_t without_pose = 0;  ///< of those given out
  std::size_t waiting = 0;
  std::array<std::size_t, drop_reasons> dropped{};

  [[nodiscard]] std::size_t of(DropReason reason) const {
    return dropped[static_cast<std::size_t>(reason)];
  }
};

/// Depth images wait here for the joint states or transforms around their stamps, which may come
/// before or after them. Nothing is extrapolated, no state is the latest: a frame comes out once
/// its pose is known, or with the status that says why not when max_wait is over.
///
/// Images stay with the caller, who gives each a key and gets it back once: from next(), or in a
/// DroppedFrame. Times `now` are nanoseconds of any clock of the caller's (log times of a bag, a
/// steady clock); if it goes back, waits start again. One instance serves one thread at a time; so
/// do all that share a history, together.
class FrameQueue {
 public:
  using OnDrop = std::function<void(const DroppedFrame&)>;  ///< must not call the queue

  /// Throws InputError for what PoseLookup refuses, times that are not finite, negative or above
  /// 1e9 s (time_offset: beyond +-1e9 s) and max_frames 0. `robot` and `history` must outlive this.
  FrameQueue(const Robot& robot, PoseHistory& history, const FrameQueueOptions& options = {},
             OnDrop on_drop = {});

  /// Takes a frame. One that is stamped a clock's jump before the newest makes the history forget
  /// its states and drops those that wait.
  void push(std::uint64_t key, std::int64_t stamp, std::int64_t now);

  /// The next frame to be processed; false if there is none yet. Call it until then, after each
  /// push, after states were added to the history, and at wake_at().
  /// Allocates nothing for a frame that is ok, once `frame` has been used.
  bool next(std::int64_t now, QueuedFrame& frame);

  /// Nothing more will be added to the history: no frame waits any longer.
  void finish() { finished_ = true; }

  /// When next() has something even if nothing is added; nothing if no frame waits.
  [[nodiscard]] std::optional<std::int64_t> wake_at() const;

  [[nodiscard]] FrameCounts counts() const;

 private:
  struct Waiting {
    std::uint64_t key;
    std::int64_t stamp;
    std::int64_t arrived;    // on the caller's clock
    std::uint64_t revision;  // of the history that did not have its pose; none at first
  };

  void follow(std::int64_t now);
  void drop(const Waiting& frame, DropReason reason);
  bool next_of_every(QueuedFrame& out);
  bool next_newest(QueuedFrame& out);
  bool decide(Waiting& frame, QueuedFrame& out);
  [[nodiscard]] bool is_over(const Waiting& frame) const;

  PoseHistory& history_;
  FrameQueueOptions options_;
  std::int64_t time_offset_;  // nanoseconds
  std::int64_t max_wait_;     // nanoseconds
  PoseLookup lookup_;
  OnDrop on_drop_;
  std::vector<Waiting> waiting_;  // as they came, or (newest) by stamp
  std::uint64_t epoch_;
  std::int64_t now_ = 0;
  std::optional<std::int64_t> newest_;     // stamp pushed in this epoch
  std::optional<std::int64_t> given_out_;  // newest stamp given out in this epoch
  bool finished_ = false;
  FrameCounts counts_;
};

}  // namespace penumbra
