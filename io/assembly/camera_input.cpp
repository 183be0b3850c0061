// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/assembly/camera_input.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// How long images wait for the camera_info and colour image with their stamp, in seconds of the
/// caller's clock. Drivers send them together, but some send one camera_info for all images.
constexpr double newest_companion_wait = 0.1, every_companion_wait = 0.2;
constexpr std::size_t newest_most_colors = 8, every_most_colors = 64;

}  // namespace

CameraInput::CameraInput(CameraInputOptions options, const RobotInput& robot)
    : SensorInput(robot, options.has_depth ? "depth image" : "image", options.poses,
                  options.known.has_value()),
      options_(std::move(options)),
      colors_(options_.known ? every_most_colors : newest_most_colors) {
  if (!options_.known) return;
  const KnownCamera& known = *options_.known;
  info_ = known.info;
  color_info_ = known.color_info;
  frame_ = known.depth_frame;
  setup_ = make_setup(known.cameras, known.mount);
}

void CameraInput::take_depth(KeptImage image, std::int64_t now) {
  const std::int64_t stamp = image.header().stamp;
  const std::string frame = image.header().frame_id;
  infos_.add_image(stamp);
  const auto waiting = begin(now);
  waiting->stamp = stamp;
  waiting->image = std::move(image);
  if (is_lossless()) {
    color_infos_.add_image(stamp);
    if (frame_name(frame) != frame_name(frame_))
      waiting->source_message = "the depth image is of the frame '" + printable(frame) +
                                "', the first one of '" + printable(frame_) + "'";
  } else {
    frame_ = frame;
    refresh();
    if (!setup_) return counts_.drop(DropReason::not_ready);
    if (stamp < valid_from_) return counts_.drop(DropReason::changed);
  }
  push(waiting, now);
}

void CameraInput::take_unreadable(const std::string& fault, std::int64_t now) {
  const std::uint64_t index = counts_.received++;
  if (!is_lossless()) return counts_.drop(DropReason::unreadable);
  const auto waiting = std::make_shared<AssembledFrame>();
  waiting->index = index;
  waiting->source_message = fault;
  waiting->arrived = now;
  keep_without_pose(waiting, "the depth image's message cannot be read");
}

bool CameraInput::take_info(const CameraInfoMessage& info) {
  const std::int64_t stamp = info.header.stamp;
  const bool differs = info_ && !is_same_camera(*info_, info);
  if (is_lossless()) {
    const bool begins = differs && !infos_.last_differs();
    infos_.add_info(stamp, differs);
    return begins;
  }
  infos_.add_info(stamp);
  const bool jumped = is_clock_jump(stamp, newest_info_);
  newest_info_ = jumped ? stamp : std::max(newest_info_, stamp);
  if (jumped) valid_from_ = 0;
  if (differs) {
    ++camera_changes_;
    valid_from_ = stamp;
  }
  if (differs || !info_) {
    info_ = info;
    ++camera_infos_;
  }
  refresh();
  return false;
}

bool CameraInput::take_color_info(const CameraInfoMessage& info) {
  const bool differs = color_info_ && !is_same_camera(*color_info_, info);
  if (is_lossless()) {
    const bool begins = differs && !color_infos_.last_differs();
    color_infos_.add_info(info.header.stamp, differs);
    return begins;
  }
  if (color_info_ && !differs) return false;
  if (differs) {
    ++camera_changes_;
    valid_from_ = std::max(valid_from_, info.header.stamp);
  }
  color_info_ = info;
  ++camera_infos_;
  refresh();
  return false;
}

void CameraInput::mount(const std::string& parent, const Eigen::Isometry3d& T_parent_camera,
                        const std::string& source) {
  options_.mount.parent = parent;
  options_.mount.pose = T_parent_camera;
  options_.mount.pose_source = source;
  ++camera_infos_;
  refresh();
}

std::shared_ptr<SensorSetup> CameraInput::find_setup() {
  if (!robot_.posed() || !info_ || frame_.empty() || lacks_color_info()) return nullptr;
  const Robot& robot = robot_.posed()->robot;
  JudgedCameras cameras = find_cameras();
  const std::string& frame = cameras.judged.frame_id;
  CameraMount mount = find_mount(robot, options_.mount, robot_.frames(), frame)
                          .value_or(mount_by_root(robot, options_.mount, frame));
  return make_setup(std::move(cameras), std::move(mount));
}

std::shared_ptr<SensorSetup> CameraInput::make_setup(JudgedCameras cameras, CameraMount mount) {
  const std::string frame = cameras.judged.frame_id;
  cameras.judged.parent = mount.parent;
  cameras.judged.T_parent_camera = mount.T_parent_camera;
  return SensorInput::make_setup(options_, std::move(cameras), std::move(mount), frame,
                                 is_lossless() ? every_companion_wait : newest_companion_wait);
}

JudgedCameras CameraInput::find_cameras() const {
  CameraEvidence evidence{.source = {},
                          .depth = {*info_, options_.info_topic, options_.depth_topic},
                          .color = {},
                          .depth_frame = frame_,
                          .info_is_named = options_.info_is_named,
                          .is_rectified = options_.is_rectified};
  if (color_info_ && !options_.color_info_topic.empty())
    evidence.color.emplace(
        InfoOfImages{*color_info_, options_.color_info_topic, options_.color_topic});
  JudgedCameras cameras = judged_cameras(evidence);
  cameras.has_depth = options_.has_depth;
  cameras.depth_scale = options_.depth_scale;
  cameras.depth_along_ray = options_.depth_along_ray;
  return cameras;
}

/// Checks an image's own camera_info, if the driver sends one with each image.
Companions CameraInput::check_info(const Frame& frame, bool over) {
  if (!infos_.are_likely() || infos_.covers(*frame.stamp)) return Companions::complete;
  if (!over) return Companions::awaited;
  if (infos_.are_certain()) return Companions::missing;
  infos_.note_missing();
  return Companions::complete;
}

/// Also awaits the colour image, and targets. An image without camera_info has a fault instead.
Companions CameraInput::check_all(const Frame& frame, bool over) const {
  const std::int64_t stamp = *frame.stamp;
  const bool has_info = infos_.are_certain() ? infos_.covers(stamp) : infos_.reaches(stamp);
  const bool has_color_info = options_.color_info_topic.empty() || color_infos_.reaches(stamp);
  const bool has_color = !with_color_ || options_.color_topic.empty() || colors_.reaches(stamp);
  return over || (has_info && has_color_info && has_color && !awaits_targets_)
             ? Companions::complete
             : Companions::awaited;
}

std::string CameraInput::fault_of(const Frame& frame) const {
  const std::string& known = frame.source_message;
  if (!is_lossless() || !known.empty()) return known;
  const std::int64_t stamp = frame.stamp.value_or(0);
  if (infos_.are_certain() && stamp > 0 && !infos_.covers(stamp))
    return "its camera_info is missing, although other images have one: it may be another camera's";
  if (infos_.differs(stamp) || color_infos_.differs(stamp))
    return "camera_info is of another camera than the first one";
  return {};
}

void CameraInput::complete(AssembledFrame& frame) {
  frame.source_message = fault_of(frame);
  frame.plan = robot_.plan();
  const std::int64_t stamp = frame.stamp.value_or(0);
  const JudgedCameras& cameras = *frame.setup->cameras();
  if (cameras.depth && knows_robot(frame.pose))
    frame.setup->posed->history.transforms().at(frame.setup->queue.pose_stamp(stamp),
                                                cameras.judged.frame_id, frame_,
                                                frame.T_judged_depth);
  if (!cameras.has_depth)
    frame.color_image = frame.image;
  else if (const KeptImage* const color = with_color_ ? colors_.find(stamp) : nullptr)
    frame.color_image = *color;
  colors_.forget_before(stamp);
}

}  // namespace penumbra::io
