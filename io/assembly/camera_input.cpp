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

std::string why_dropped(DropReason reason) {
  switch (reason) {
    case DropReason::no_stamp:
      return "the depth image's stamp is 0: it is not known when it was taken";
    case DropReason::clock_jump:
      return "the clock jumped back while the depth image waited for its pose";
    default:
      return "too many depth images waited for their poses";
  }
}

}  // namespace

CameraInput::CameraInput(CameraInputOptions options, const RobotInput& robot)
    : options_(std::move(options)),
      robot_(robot),
      colors_(options_.known ? every_most_colors : newest_most_colors) {
  if (!options_.known) return;
  const KnownCamera& known = *options_.known;
  info_ = known.info;
  color_info_ = known.color_info;
  depth_frame_ = known.depth_frame;
  setup_ = make_setup(known.cameras, known.mount);
}

void CameraInput::take_depth(KeptImage image, std::int64_t now) {
  const std::uint64_t index = counts_.received++;
  const std::int64_t stamp = image.header().stamp;
  const std::string frame = image.header().frame_id;
  infos_.add_image(stamp);
  const auto waiting = std::make_shared<AssembledFrame>();
  waiting->index = index;
  waiting->stamp = stamp;
  waiting->image = std::move(image);
  waiting->arrived = now;
  if (is_lossless()) {
    color_infos_.add_image(stamp);
    if (frame_name(frame) != frame_name(depth_frame_))
      waiting->source_message = "the depth image is of the frame '" + printable(frame) +
                                "', the first one of '" + printable(depth_frame_) + "'";
  } else {
    arrivals_.add(now);
    depth_frame_ = frame;
    refresh();
    if (!setup_) return counts_.drop(DropReason::not_ready);
    if (stamp < valid_from_) return counts_.drop(DropReason::changed);
  }
  setup_->queue.push(waiting, now);
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
    ++cameras_revision_;
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
  ++cameras_revision_;
  refresh();
  return false;
}

void CameraInput::refresh() {
  if (is_lossless()) return;
  Basis basis{.robot = robot_.posed().get(),
              .frames = robot_.frames_revision(),
              .cameras = cameras_revision_,
              .depth_frame = depth_frame_};
  if (basis == basis_) return;
  const bool only_frames_are_new = setup_ && basis.robot == basis_.robot &&
                                   basis.cameras == basis_.cameras &&
                                   basis.depth_frame == basis_.depth_frame;
  basis_ = std::move(basis);
  setup_fault_.clear();
  std::shared_ptr<CameraSetup> made = find_setup();
  if (only_frames_are_new && made && made->mount == setup_->mount) return;
  replace_setup(std::move(made));
}

void CameraInput::replace_setup(std::shared_ptr<CameraSetup> setup) {
  if (setup_) {
    counts_.drop(DropReason::changed, setup_->queue.waiting());
    targets_.replaced += setup_->targets.replaced();
    targets_.discarded += setup_->targets.discarded() + setup_->targets.waiting();
  }
  setup_ = std::move(setup);
}

std::shared_ptr<CameraSetup> CameraInput::find_setup() {
  if (!robot_.posed() || !info_ || depth_frame_.empty() || lacks_color_info()) return nullptr;
  const Robot& robot = robot_.posed()->robot;
  try {
    JudgedCameras cameras = find_cameras();
    const std::string& frame = cameras.judged.frame_id;
    CameraMount mount = find_mount(robot, options_.mount, robot_.frames(), frame)
                            .value_or(mount_by_root(robot, options_.mount, frame));
    return make_setup(std::move(cameras), std::move(mount));
  } catch (const InputError& error) {
    setup_fault_ = error.what();
    return nullptr;
  }
}

std::shared_ptr<CameraSetup> CameraInput::make_setup(JudgedCameras cameras, CameraMount mount) {
  const FrameQueueOptions queue{
      .policy = is_lossless() ? DropPolicy::every : DropPolicy::newest,
      .time_offset = options_.time_offset,
      .max_wait = options_.max_wait,
      .companion_wait = is_lossless() ? every_companion_wait : newest_companion_wait,
      .max_frames = options_.max_frames,
      .poses = {.source = options_.poses,
                .frame_prefix = options_.mount.frame_prefix,
                .camera_parent = mount.parent,
                .camera_frame = mount.frame}};
  const auto on_drop = [this](std::shared_ptr<Frame> frame, DropReason reason) {
    if (is_lossless()) return keep_without_pose(std::move(frame), why_dropped(reason));
    counts_.drop(reason);
    if (reason == DropReason::no_camera_info) ++without_info_;
  };
  const auto check = [this](const Frame& frame, bool over) {
    return is_lossless() ? check_all(frame, over) : check_info(frame, over);
  };
  return std::make_shared<CameraSetup>(robot_.posed(), std::move(cameras), std::move(mount), queue,
                                       options_.hidden_targets, on_drop, check);
}

JudgedCameras CameraInput::find_cameras() const {
  CameraEvidence evidence{.source = {},
                          .depth = {*info_, options_.info_topic, options_.depth_topic},
                          .color = {},
                          .depth_frame = depth_frame_,
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

void CameraInput::finish() {
  if (setup_) setup_->queue.finish();
}

void CameraInput::keep_without_pose(std::shared_ptr<Frame> frame, const std::string& why) {
  if (frame->stamp.value_or(0) <= 0) frame->stamp.reset();
  frame->pose = {.status = options_.poses == PoseSource::transforms ? FrameStatus::missing_transform
                                                                    : FrameStatus::missing_joints,
                 .message = why};
  without_pose_.push_back(std::move(frame));
}

/// Checks an image's own camera_info, if the driver sends one with each image.
Companions CameraInput::check_info(const Frame& frame, bool over) {
  if (!infos_.are_likely() || infos_.covers(*frame.stamp)) return Companions::complete;
  if (!over) return Companions::awaited;
  if (infos_.are_certain()) return Companions::missing;
  infos_.note_missing();
  return Companions::complete;
}

/// Also awaits the colour image. An image without camera_info has a fault instead.
Companions CameraInput::check_all(const Frame& frame, bool over) const {
  const std::int64_t stamp = *frame.stamp;
  const bool has_info = infos_.are_certain() ? infos_.covers(stamp) : infos_.reaches(stamp);
  const bool has_color_info = options_.color_info_topic.empty() || color_infos_.reaches(stamp);
  const bool has_color = !with_color_ || options_.color_topic.empty() || colors_.reaches(stamp);
  return over || (has_info && has_color_info && has_color) ? Companions::complete
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

bool CameraInput::next(std::int64_t now, bool with_color, AssembledFrame& next) {
  with_color_ = with_color;
  const auto is_without_pose = [this] {
    const Frame* const first = setup_ ? setup_->queue.first() : nullptr;
    return !without_pose_.empty() &&
           (first == nullptr || without_pose_.front()->index < first->index);
  };
  std::shared_ptr<Frame> found;
  if (setup_ && !is_without_pose()) found = setup_->queue.next(now);
  if (!found && is_without_pose()) {
    found = std::move(without_pose_.front());
    without_pose_.pop_front();
  }
  if (!found) return false;
  without_info_ = 0;
  next = std::move(static_cast<AssembledFrame&>(*found));
  next.setup = setup_;
  next.source_message = fault_of(next);
  next.targets = setup_->targets.take();
  next.plan = robot_.plan();
  const std::int64_t stamp = next.stamp.value_or(0);
  if (setup_->cameras.depth && has_pose(next.pose.status))
    setup_->posed->history.transforms().at(setup_->queue.pose_stamp(stamp),
                                           setup_->cameras.judged.frame_id, depth_frame_,
                                           next.T_judged_depth);
  if (!setup_->cameras.has_depth)
    next.color_image = next.image;
  else if (const KeptImage* const color = with_color ? colors_.find(stamp) : nullptr)
    next.color_image = *color;
  colors_.forget_before(stamp);
  ++counts_.in_work;
  return true;
}

void CameraInput::done(bool is_judged, std::size_t unjudged_targets) {
  --counts_.in_work;
  ++(is_judged ? counts_.judged : counts_.failed);
  targets_.discarded += unjudged_targets;
}

UnjudgedTargets CameraInput::targets() const {
  UnjudgedTargets all = targets_;
  if (setup_) {
    all.replaced += setup_->targets.replaced();
    all.discarded += setup_->targets.discarded();
  }
  return all;
}

ImageCounts CameraInput::counts() const {
  ImageCounts counts = counts_;
  counts.waiting = (setup_ ? setup_->queue.waiting() : 0) + without_pose_.size();
  return counts;
}

}  // namespace penumbra::io
