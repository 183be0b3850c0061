// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/info_pairs.hpp>
#include <io/live/live_job.hpp>
#include <io/live/live_robot.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

struct LiveCameraOptions {
  std::string name = {};         ///< empty if there is one camera only
  std::string depth_topic = {};  ///< the topic names are used in messages to the user
  std::string info_topic = {};
  std::string color_topic = {};       ///< empty: none
  std::string color_info_topic = {};  ///< empty: depth is judged in its own image
  MountOptions mount = {};
  bool info_is_named = false;  ///< CameraEvidence
  bool is_rectified = false;   ///< likewise
  PoseSource poses = PoseSource::joints;
  double time_offset = 0.0;    ///< see FrameQueueOptions
  double max_wait = 0.2;       ///< likewise
  std::size_t max_frames = 8;  ///< likewise
};

/// The reason why an image was not judged.
enum class LiveDrop {
  superseded,  ///< this and the next four are those of DropReason
  late,
  overflow,
  clock_jump,
  no_stamp,
  unreadable,     ///< the message cannot be decoded
  not_ready,      ///< no robot or no camera_info was known yet
  changed,        ///< robot, camera_info or mount changed while it waited, or it was taken before
  no_camera_info  ///< its own camera_info is missing, other images have one
};
inline constexpr std::size_t live_drops = 9;
[[nodiscard]] std::string_view to_string(LiveDrop reason);

/// Counts depth images by result: received = judged + failed + dropped + waiting + in_work.
struct LiveCounts {
  std::size_t received = 0;
  std::size_t judged = 0;  ///< judged and published
  std::size_t failed = 0;  ///< no result could be computed
  std::size_t waiting = 0;
  std::size_t in_work = 0;
  std::array<std::size_t, live_drops> dropped{};

  [[nodiscard]] std::size_t of(LiveDrop reason) const {
    return dropped[static_cast<std::size_t>(reason)];
  }
};

/// Targets that were never judged.
struct LiveTargets {
  std::size_t replaced = 0;  ///< replaced by newer targets of the same name
  /// Sums TargetInbox::discarded, the targets that waited when the setup changed, and the targets
  /// of images that failed.
  std::size_t discarded = 0;
  std::size_t early = 0;  ///< messages received before robot and camera were known
};

/// Receives the messages of one camera and keeps depth images until they can be judged, newest
/// first. Uses no threads and no clock, like FrameQueue.
class LiveCamera {
 public:
  /// How long an image waits for its own camera_info if the driver sends one with each image, in
  /// nanoseconds.
  static constexpr std::int64_t companion_wait = 100'000'000;

  /// `robot` must outlive this. Throws InputError for options that FrameQueue refuses.
  LiveCamera(LiveCameraOptions options, const LiveRobot& robot);

  void take_depth(KeptImage image, std::int64_t now);
  /// Counts an image that cannot be decoded.
  void drop_unreadable();
  void take_info(const CameraInfoMessage& info, std::int64_t now);
  void take_color_info(const CameraInfoMessage& info);
  void take_color(KeptImage image) { colors_.add(std::move(image)); }
  template <typename M>
  void take_targets(const std::string& topic, const M& message) {
    if (setup_)
      setup_->targets.add(topic, message);
    else
      ++targets_.early;
  }

  /// Updates the setup. Call this when the robot may have changed.
  void follow_robot() { refresh(); }

  /// Sets `job` to the next image to judge. Returns false if no image is ready. `with_color`: adds
  /// the colour image.
  bool next(std::int64_t now, bool with_color, LiveJob& job);
  /// Counts the outcome of a job. Call this once for each job.
  void done(const LiveOutcome& outcome);
  /// Returns when next() will have an image even if no message arrives.
  [[nodiscard]] std::optional<std::int64_t> wake_at() const;

  [[nodiscard]] const LiveCameraOptions& options() const { return options_; }
  [[nodiscard]] LiveCounts counts() const;
  /// Returns the current setup, or null if setup_fault() is set or robot or camera are not known.
  [[nodiscard]] const LiveSetup* setup() const { return setup_.get(); }
  [[nodiscard]] const std::string& setup_fault() const { return setup_fault_; }
  [[nodiscard]] bool has_info() const { return info_.has_value(); }
  [[nodiscard]] bool lacks_color_info() const {
    return !options_.color_info_topic.empty() && !color_info_;
  }
  /// Returns the number of consecutive images that were dropped as LiveDrop::no_camera_info.
  [[nodiscard]] std::size_t without_info() const { return without_info_; }
  [[nodiscard]] std::size_t camera_changes() const { return camera_changes_; }
  [[nodiscard]] std::optional<std::int64_t> last_depth() const { return last_depth_; }
  /// Returns the stamp of the last image.
  [[nodiscard]] std::int64_t last_stamp() const { return last_stamp_; }
  /// Returns the period of the images in nanoseconds, or nothing if it is not known yet. It is the
  /// shortest of the last intervals, because a long one may be a pause.
  [[nodiscard]] std::optional<std::int64_t> depth_period() const;
  [[nodiscard]] LiveTargets targets() const;

 private:
  struct Waiting {
    KeptImage image;
    std::int64_t arrived = 0;
  };
  /// The state of an image's own camera_info if the driver sends one with each image.
  enum class InfoState { known, awaited, missing };
  /// The inputs of a setup.
  struct Basis {
    const PosedRobot* robot = nullptr;
    std::uint64_t frames = 0, cameras = 0;
    std::string depth_frame;
    bool operator==(const Basis&) const = default;
  };

  void refresh();
  [[nodiscard]] std::shared_ptr<LiveSetup> make_setup();
  [[nodiscard]] JudgedCameras find_cameras() const;
  void drop_waiting(LiveDrop reason);
  void drop(LiveDrop reason) { ++counts_.dropped[static_cast<std::size_t>(reason)]; }
  void admit(std::int64_t now);
  [[nodiscard]] InfoState find_info(const Waiting& waiting, std::int64_t now);

  LiveCameraOptions options_;
  const LiveRobot& robot_;
  std::shared_ptr<LiveSetup> setup_;
  Basis basis_;  // of the setup, or of the last attempt to make one
  std::string setup_fault_;
  std::optional<CameraInfoMessage> info_, color_info_;
  std::uint64_t cameras_revision_ = 0;
  std::size_t camera_changes_ = 0;
  std::int64_t valid_from_ = 0;   // images with earlier stamps come from another camera
  std::int64_t newest_info_ = 0;  // stamp
  InfoPairs pairs_;
  std::size_t without_info_ = 0;
  std::string depth_frame_;
  std::deque<Waiting> arrived_;              // images that wait for their camera_info
  std::map<std::uint64_t, Waiting> queued_;  // those in the setup's queue, by key
  std::uint64_t next_key_ = 0;
  ColorImages colors_;
  LiveCounts counts_;
  std::optional<std::int64_t> last_depth_;
  std::int64_t last_stamp_ = 0;
  std::deque<std::int64_t> intervals_;  // between the last depth images
  LiveTargets targets_;                 // of previous setups
};

}  // namespace penumbra::io
