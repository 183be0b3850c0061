// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// Which frames are returned.
enum class DropPolicy {
  newest,  ///< the newest whose pose came or was waited for; drops earlier ones. For live images
  every    ///< all, in the order of arrival. For bags
};

/// The reason why an image was dropped. A FrameQueue has the first five and the last.
enum class DropReason {
  superseded,     ///< a newer one was returned instead (newest)
  late,           ///< it came after one of its stamp or later was returned (newest)
  overflow,       ///< max_frames were waiting; drops the oldest (newest) or the new one (every)
  clock_jump,     ///< it is from before the clock jumped back
  no_stamp,       ///< its stamp is 0 or negative
  unreadable,     ///< its message cannot be decoded
  not_ready,      ///< no robot or no camera_info was known yet
  changed,        ///< robot, camera_info or mount changed while it waited, or it is older than that
  no_camera_info  ///< its own camera_info is missing, other images have one
};
inline constexpr std::size_t drop_reasons = 9;
[[nodiscard]] std::string_view to_string(DropReason reason);

struct FrameQueueOptions {
  DropPolicy policy = DropPolicy::newest;
  /// Seconds added to an image's stamp before poses are looked up; negative if images are stamped
  /// later than they are taken.
  double time_offset = 0.0;
  double max_wait = 0.2;        ///< seconds on the caller's clock that an image waits for its pose
  double companion_wait = 0.0;  ///< likewise, for what comes with it (FrameQueue::Check)
  std::size_t max_frames = 32;  ///< waiting at once; with `every`, the first waits no longer then
  PoseOptions poses = {};
};

/// Messages that come with an image, such as its camera_info.
enum class Companions {
  complete,
  awaited,
  missing  ///< the image is dropped (no_camera_info)
};

/// Holds depth images and scans until the joint states or transforms around their stamps, and
/// around the stamp of a scan's last point, have arrived. A scan, and with `every` an image, comes
/// with Frame::pose_at, which reads the history, and is valid as long as the queue. Never
/// extrapolates: a frame is returned with its pose, or after max_wait with the status. Links that
/// are uncertain are awaited as well, unless their last state is older than the image by more than
/// max_wait.
///
/// Each frame comes back once: from next(), or by OnDrop. It may be of a class derived from Frame.
/// Times `now` are nanoseconds of any clock (log times of a bag, a steady clock); if it goes back,
/// waits start again. One instance serves one thread at a time, as do all users of one history
/// together.
class FrameQueue {
 public:
  /// Must not call the queue.
  using OnDrop = std::function<void(std::shared_ptr<Frame>, DropReason)>;
  /// Returns whether a frame's companions are there. It is awaited no longer if it is `over`.
  using Check = std::function<Companions(const Frame&, bool over)>;

  /// Throws InputError as PoseLookup does, and for times that are not finite, negative (except
  /// time_offset) or above 1e9 s, and max_frames 0. `robot` and `history` must outlive this.
  FrameQueue(const Robot& robot, PoseHistory& history, const FrameQueueOptions& options = {},
             OnDrop on_drop = {}, Check check = {});

  /// Adds a frame, by its stamp; without one it is dropped. A stamp that is a clock jump before the
  /// newest clears the history and drops waiting frames, but with `every` not those with a pose.
  void push(std::shared_ptr<Frame> frame, std::int64_t now);
  void push(Frame frame, std::int64_t now) { push(std::make_shared<Frame>(std::move(frame)), now); }

  /// Returns the next frame to process, with its pose; null if there is none yet. Call it until
  /// null after each push, after adding states to the history, and at wake_at().
  [[nodiscard]] std::shared_ptr<Frame> next(std::int64_t now);

  /// Returns the stamp, with time_offset, of the pose of an image with this stamp.
  [[nodiscard]] std::int64_t pose_stamp(std::int64_t stamp) const;

  /// Tells the queue that the history is complete: no frame waits any longer.
  void finish() { finished_ = true; }

  /// Returns when next() has a frame even without new states; null if no frame waits.
  [[nodiscard]] std::optional<std::int64_t> wake_at() const;

  /// Returns the first of the frames that wait; null if there is none.
  [[nodiscard]] const Frame* first() const {
    return waiting_.empty() ? nullptr : waiting_.front().frame.get();
  }

  /// Returns how many frames wait.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    std::shared_ptr<Frame> frame;
    std::int64_t stamp;       // of its last measurement
    std::int64_t arrived;     // on the caller's clock
    std::uint64_t revision;   // of the history when its pose was last looked up
    bool has_result = false;  // its pose is known, or is no longer awaited
  };

  void follow(std::int64_t now);
  [[nodiscard]] std::vector<Waiting>::iterator find_next();
  [[nodiscard]] Companions decide(Waiting& waiting);
  void find_pose(Waiting& waiting);
  [[nodiscard]] bool is_over(const Waiting& waiting, std::int64_t max_wait) const;
  [[nodiscard]] bool awaits_links(std::int64_t at) const;

  PoseHistory& history_;
  FrameQueueOptions options_;
  std::int64_t time_offset_;                // nanoseconds
  std::int64_t max_wait_, companion_wait_;  // likewise
  PoseLookup lookup_;
  OnDrop on_drop_;
  Check check_;
  std::vector<Waiting> waiting_;  // in order of arrival, or (newest) by stamp
  std::uint64_t epoch_;
  std::int64_t now_ = 0;
  std::optional<std::int64_t> newest_;     // pushed stamp of this epoch
  std::optional<std::int64_t> first_;      // pose's stamp of the first one pushed in this epoch
  std::optional<std::int64_t> given_out_;  // newest returned stamp of this epoch
  bool finished_ = false;
};

}  // namespace penumbra
