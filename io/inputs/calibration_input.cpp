// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/image_size.hpp>
#include <io/files/png.hpp>
#include <io/inputs/calibration_input.hpp>

namespace penumbra::io {
namespace {

constexpr double still = 0.01;   // metres per second of any link's origin
constexpr double moving = 0.05;  // the same, at least, to tell the time offset
constexpr double fixed = 0.002;  // metres and rad that a fixed camera may move on its link

/// The fastest link's speed since the frame before, m/s; none without stamps.
class Speed {
 public:
  std::optional<double> of(const Frame& frame, const std::vector<Eigen::Isometry3d>& poses) {
    std::optional<double> speed;
    if (frame.stamp && before_ && *frame.stamp > *before_) {
      double most = 0.0;
      for (std::size_t i = 0; i < poses.size(); ++i)
        most = std::max(most, (poses[i].translation() - poses_[i].translation()).norm());
      speed = most / (1e-9 * static_cast<double>(*frame.stamp - *before_));
    }
    before_ = frame.stamp;
    poses_ = poses;
    return speed;
  }

 private:
  std::optional<std::int64_t> before_;
  std::vector<Eigen::Isometry3d> poses_;
};

template <typename T>
Image<T> rectified_copy(const std::optional<Rectification>& lens, const Image<T>& raw) {
  Image<T> image;
  return copy_of(rectified(lens ? &*lens : nullptr, raw.view(), image));
}

/// Takes the camera's pose in tf as the input's. Throws InputError if it is not that of `known`.
void take_camera_pose(const Eigen::Isometry3d& T_parent_camera,
                      std::optional<Eigen::Isometry3d>& known, const std::string& frame,
                      PipelineConfig& config) {
  if (!known) known = config.T_parent_camera = T_parent_camera;
  const Eigen::Isometry3d motion = known->inverse() * T_parent_camera;
  if (motion.translation().norm() > fixed ||
      std::abs(Eigen::AngleAxisd(motion.linear()).angle()) > fixed)
    throw InputError(frame + ": tf moves the camera on link '" + config.camera_parent +
                     "', and only a camera that is fixed to a link is calibrated; choose frames "
                     "with --frames, or its link with --parent and --initial");
}

}  // namespace

CalibrationInput read_calibration_input(const CalibrationInputOptions& options,
                                        const LineSink& print, const std::function<void()>& step) {
  RunInput input = open_input(options.input, print);
  std::optional<Rectification> lens;
  if (!input.camera.distortion.is_none()) lens.emplace(input.camera);
  const Intrinsics camera = lens ? lens->pinhole() : input.camera.intrinsics;
  std::optional<FramePattern> masks;
  const auto& path = options.input.path;
  if (options.masks)
    masks.emplace(*options.masks, std::filesystem::is_directory(path) ? path : path.parent_path(),
                  input.stamps);

  const bool has_depth = input.config.has_depth;
  if (!has_depth && !masks) throw InputError(path.string() + ": has no depth: give --masks");
  const Robot& robot = input.robot;
  const auto source = input.frames(robot);
  Frame frame;
  CalibrationFrames resting, all;
  StampedPoses trajectory;
  std::map<std::size_t, std::int64_t> stamps;
  Speed speed;
  std::size_t seen = 0, faulty = 0, unmasked = 0;
  std::string fault, no_mask;
  std::optional<Eigen::Isometry3d> in_tf;
  while (source->next(frame)) {
    ++seen;
    step();
    CalibrationFrame kept{.index = frame.index.value_or(seen - 1),
                          .depth = {},
                          .mask = {},
                          .joints = {},
                          .T_root_link = {},
                          .nearby = {}};
    const RobotPose& pose = frame.pose;
    const bool has_joints = pose.positions.size() == robot.variables().size();
    const bool is_partial = std::ranges::any_of(
        pose.uncertain_links, [&](std::size_t link) { return robot.report()[link].drawn; });
    if (pose.status != FrameStatus::ok || is_partial || frame.source_status != FrameStatus::ok ||
        (has_depth && is_empty(frame.depth.view)) || (pose.T_root_link.empty() && !has_joints)) {
      const std::string& why = is_partial             ? pose.uncertain_reason
                               : pose.message.empty() ? frame.source_message
                                                      : pose.message;
      if (faulty++ == 0)
        fault = "frame " + std::to_string(kept.index) + ": " +
                (why.empty() ? "no joints or no depth" : why);
      continue;
    }
    if (pose.T_parent_camera)
      take_camera_pose(*pose.T_parent_camera, in_tf,
                       path.string() + ": frame " + std::to_string(kept.index), input.config);
    kept.T_root_link = pose.T_root_link;
    if (kept.T_root_link.empty()) {
      kept.joints = pose.positions;
      kept.T_root_link.resize(robot.links().size());
      robot.forward_kinematics(kept.joints, kept.T_root_link);
    }
    const std::optional<double> now = speed.of(frame, kept.T_root_link);
    const bool rests = !now || *now <= still;
    const bool will_rest = resting.frames().size() >= CalibrationFrames::least;
    if (frame.stamp && (options.time_offset || !will_rest)) {
      trajectory.emplace_back(*frame.stamp, kept.T_root_link);
      stamps[kept.index] = *frame.stamp;
    } else if (options.time_offset) {
      throw InputError(path.string() + ": has no stamps: a time offset cannot be estimated");
    }
    if (options.time_offset && (!now || *now < moving)) continue;
    if (!all.wants(kept.T_root_link) && !(rests && resting.wants(kept.T_root_link))) continue;
    if (masks) {
      Image<std::uint8_t> mask;
      const auto file = masks->file(static_cast<std::int64_t>(kept.index));
      if (!std::filesystem::exists(file)) {
        if (unmasked++ == 0) no_mask = file.string();
        continue;
      }
      if (const FileResult read = read_png(
              file, mask,
              ImageSize{input.camera.intrinsics.width(), input.camera.intrinsics.height()});
          !read.ok())
        throw InputError("--masks: " + read.message);
      kept.mask = rectified_copy(lens, mask);
    }
    if (has_depth)
      kept.depth = rectified_copy(
          lens, metres_of(frame.depth.view, {input.camera.range.near, input.camera.range.far}));
    if (rests) resting.add(kept);
    all.add(std::move(kept));
  }

  if (unmasked > 0 && all.frames().empty() && resting.frames().empty())
    throw InputError("--masks: " + no_mask + " is not there");
  CalibrationInput result{.input = std::move(input),
                          .camera = camera,
                          .frames = {},
                          .seen = seen,
                          .notes = source->notes()};
  const bool rested = !options.time_offset && resting.frames().size() >= CalibrationFrames::least;
  const auto chosen = (rested ? resting : all).frames();
  result.frames.assign(chosen.begin(), chosen.end());
  if (!rested)
    for (CalibrationFrame& kept : result.frames)
      if (const auto stamp = stamps.find(kept.index); stamp != stamps.end())
        kept.nearby = nearby_poses(trajectory, stamp->second);
  if (options.time_offset)
    std::erase_if(result.frames, [](const auto& kept) { return kept.nearby.empty(); });
  if (!rested && !options.time_offset && resting.frames().size() < chosen.size())
    result.notes.push_back(
        "the arm moves in most frames: joint states that are early or late move the result; let it "
        "stand still at some ten poses");
  if (unmasked > 0)
    result.notes.push_back("frames without a mask are left out: " + std::to_string(unmasked) +
                           ", the first " + no_mask);
  if (faulty > 0)
    result.notes.push_back(std::to_string(faulty) + " of " + std::to_string(seen) +
                           " frames cannot be used; the first is " + fault);
  return result;
}

}  // namespace penumbra::io
