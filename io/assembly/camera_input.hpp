// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/poses/robot_pose.hpp>

#include <io/assembly/camera_infos.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/sensor_input.hpp>
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
  bool has_targets = false;    ///< images of bags wait for targets that come later
  HiddenTargets hidden_targets = HiddenTargets::not_handled;
  /// Set for bags: every image becomes a frame; one of another camera, without a pose or unreadable
  /// says so (DropPolicy::every). Not set for live topics: the setup follows what is received, and
  /// the newest image is given (DropPolicy::newest).
  std::optional<KnownCamera> known = {};
};

/// The images of one camera, which wait for their camera_info, too.
class CameraInput final : public SensorInput {
 public:
  /// `robot` must outlive this. Throws InputError for options that FrameQueue refuses.
  CameraInput(CameraInputOptions options, const RobotInput& robot);

  void take_depth(KeptImage image, std::int64_t now);
  /// Takes a depth message that cannot be decoded.
  void take_unreadable(const std::string& fault, std::int64_t now);
  /// Both return whether the camera is another one than the known one, and was not before.
  bool take_info(const CameraInfoMessage& info);
  bool take_color_info(const CameraInfoMessage& info);
  /// See FrameAssembler.
  void mount(const std::string& parent, const Eigen::Isometry3d& T_parent_camera,
             const std::string& source);
  void take_color(KeptImage image) { colors_.add(std::move(image)); }

  [[nodiscard]] const CameraInputOptions& options() const { return options_; }
  [[nodiscard]] bool has_info() const { return info_.has_value(); }
  [[nodiscard]] bool lacks_color_info() const {
    return !options_.color_info_topic.empty() && !color_info_;
  }
  /// Returns the number of consecutive images that were dropped as DropReason::no_camera_info.
  [[nodiscard]] std::size_t without_info() const { return without_info_; }
  [[nodiscard]] std::size_t camera_changes() const { return camera_changes_; }

 private:
  std::shared_ptr<SensorSetup> find_setup() override;
  [[nodiscard]] Companions check(const Frame& frame, bool over) override {
    return is_lossless() ? check_all(frame, over) : check_info(frame, over);
  }
  void complete(AssembledFrame& frame) override;
  std::shared_ptr<SensorSetup> make_setup(JudgedCameras cameras, CameraMount mount);
  [[nodiscard]] JudgedCameras find_cameras() const;
  [[nodiscard]] Companions check_info(const Frame& frame, bool over);
  [[nodiscard]] Companions check_all(const Frame& frame, bool over) const;
  [[nodiscard]] std::string fault_of(const Frame& frame) const;

  CameraInputOptions options_;
  std::optional<CameraInfoMessage> info_, color_info_;
  std::size_t camera_changes_ = 0;
  std::int64_t valid_from_ = 0;   // images with earlier stamps come from another camera
  std::int64_t newest_info_ = 0;  // stamp
  CameraInfos infos_, color_infos_;
  ColorImages colors_;
};

}  // namespace penumbra::io
