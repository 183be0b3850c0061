// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/poses/pose_lookup.hpp>

#include <io/assembly/arrivals.hpp>
#include <io/assembly/assembled_frame.hpp>
#include <io/assembly/camera_infos.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A camera that was read before its images, as from a bag.
struct KnownCamera {
  CameraInfoMessage info;
  std::optional<CameraInfoMessage> color_info;  ///< if depth is registered to the color camera
  std::string depth_frame;                      ///< frame_id of the depth images
  JudgedCameras cameras;
  CameraMount mount;
};

struct CameraInputOptions {
  std::string name = {};         ///< empty if there is one camera only
  std::string depth_topic = {};  ///< the topic names are used in messages to the user
  std::string info_topic = {};
  std::string color_topic = {};       ///< empty: none
  std::string color_info_topic = {};  ///< empty: depth is judged in its own image
  MountOptions mount = {};
  bool has_depth = true;                   ///< false: `depth_topic` has colour images
  std::optional<double> depth_scale = {};  ///< JudgedCameras
  bool depth_along_ray = false;            ///< likewise
  bool info_is_named = false;              ///< CameraEvidence
  bool is_rectified = false;               ///< likewise
  PoseSource poses = PoseSource::joints;
  double time_offset = 0.0;    ///< see FrameQueueOptions
  double max_wait = 0.2;       ///< likewise
  std::size_t max_frames = 8;  ///< likewise
  HiddenTargets hidden_targets = HiddenTargets::not_handled;
  /// Set for bags: every image becomes a frame; one of another camera, without a pose or unreadable
  /// says so (DropPolicy::every). Not set for live topics: the setup follows what is received, and
  /// the newest image is given (DropPolicy::newest).
  std::optional<KnownCamera> known = {};
};

/// Targets that were never judged.
struct UnjudgedTargets {
  std::size_t replaced = 0;  ///< replaced by newer targets of the same name
  /// Sums TargetInbox::discarded, the targets that waited when the setup changed, and the targets
  /// of images that failed.
  std::size_t discarded = 0;
  std::size_t early = 0;  ///< messages received before robot and camera were known
};

/// The messages of one camera: keeps depth images until their pose is known and their camera_info
/// has come. Part of FrameAssembler; uses no threads and no clock.
class CameraInput {
 public:
  /// `robot` must outlive this. Throws InputError for options that FrameQueue refuses.
  CameraInput(CameraInputOptions options, const RobotInput& robot);

  void take_depth(KeptImage image, std::int64_t now);
  /// Takes a depth message that cannot be decoded.
  void take_unreadable(const std::string& fault, std::int64_t now);
  /// Both return whether the camera is another one than the known one, and was not before.
  bool take_info(const CameraInfoMessage& info);
  bool take_color_info(const CameraInfoMessage& info);
  void take_color(KeptImage image) { colors_.add(std::move(image)); }
  template <typename M>
  void take_targets(const std::string& topic, const M& message) {
    if (setup_)
      setup_->targets.add(topic, message);
    else
      ++targets_.early;
  }

  /// Updates the setup. Call this when the robot may have changed.
  void refresh();
  /// Gives out what waits: no further message will come.
  void finish();

  /// See FrameAssembler.
  bool next(std::int64_t now, bool with_color, AssembledFrame& next);
  void done(bool is_judged, std::size_t unjudged_targets);
  [[nodiscard]] std::optional<std::int64_t> wake_at() const {
    return setup_ ? setup_->queue.wake_at() : std::nullopt;
  }

  [[nodiscard]] const CameraInputOptions& options() const { return options_; }
  [[nodiscard]] ImageCounts counts() const;
  /// Returns the current setup, or null if setup_fault() is set or robot or camera are not known.
  [[nodiscard]] const CameraSetup* setup() const { return setup_.get(); }
  [[nodiscard]] const std::string& setup_fault() const { return setup_fault_; }
  [[nodiscard]] bool has_info() const { return info_.has_value(); }
  [[nodiscard]] bool lacks_color_info() const {
    return !options_.color_info_topic.empty() && !color_info_;
  }
  /// Returns the number of consecutive images that were dropped as DropReason::no_camera_info.
  [[nodiscard]] std::size_t without_info() const { return without_info_; }
  [[nodiscard]] std::size_t camera_changes() const { return camera_changes_; }
  [[nodiscard]] const Arrivals& arrivals() const { return arrivals_; }  ///< of depth images
  [[nodiscard]] UnjudgedTargets targets() const;

 private:
  /// The inputs of a setup.
  struct Basis {
    const PosedRobot* robot = nullptr;
    std::uint64_t frames = 0, cameras = 0;
    std::string depth_frame;
    bool operator==(const Basis&) const = default;
  };

  [[nodiscard]] bool is_lossless() const { return options_.known.has_value(); }
  [[nodiscard]] std::shared_ptr<CameraSetup> find_setup();
  [[nodiscard]] std::shared_ptr<CameraSetup> make_setup(JudgedCameras cameras, CameraMount mount);
  [[nodiscard]] JudgedCameras find_cameras() const;
  void replace_setup(std::shared_ptr<CameraSetup> setup);
  void keep_without_pose(std::shared_ptr<Frame> frame, const std::string& why);
  [[nodiscard]] Companions check_info(const Frame& frame, bool over);
  [[nodiscard]] Companions check_all(const Frame& frame, bool over) const;
  [[nodiscard]] std::string fault_of(const Frame& frame) const;

  CameraInputOptions options_;
  const RobotInput& robot_;
  std::shared_ptr<CameraSetup> setup_;
  Basis basis_;  // of the setup, or of the last attempt to make one
  std::string setup_fault_;
  std::optional<CameraInfoMessage> info_, color_info_;
  std::uint64_t cameras_revision_ = 0;
  std::size_t camera_changes_ = 0;
  std::int64_t valid_from_ = 0;   // images with earlier stamps come from another camera
  std::int64_t newest_info_ = 0;  // stamp
  CameraInfos infos_, color_infos_;
  std::size_t without_info_ = 0;
  std::string depth_frame_;
  std::deque<std::shared_ptr<Frame>> without_pose_;  // not in the queue
  bool with_color_ = false;
  ColorImages colors_;
  ImageCounts counts_;
  Arrivals arrivals_;
  UnjudgedTargets targets_;  // of previous setups
};

}  // namespace penumbra::io
