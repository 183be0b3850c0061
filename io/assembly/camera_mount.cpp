// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/files/names.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::io {
namespace {

void check_parent(const Robot& robot, const std::string& link) {
  if (robot.find_link(link)) return;
  const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
  throw InputError("--parent: '" + link + "' is not a link of the robot" + near_names(link, known));
}

/// Returns the link that has this frame, or an empty text.
std::string link_of(const Robot& robot, const std::string& prefix, const std::string& frame) {
  if (!frame.starts_with(prefix)) return {};
  std::string link = frame.substr(prefix.size());
  return robot.find_link(link) ? link : std::string();
}

}  // namespace

MountOptions mount_options(const BagOptions& bag) {
  MountOptions options{.camera_frame = bag.camera_frame,
                       .parent = bag.parent,
                       .pose = {},
                       .frame_prefix = bag.frame_prefix};
  if (!bag.pose) return options;
  options.pose = read_pose_csv(*bag.pose);
  options.pose_source = "--pose " + bag.pose->string();
  return options;
}

bool is_above_robot(const Robot& robot, const MountOptions& options, const FrameTree& frames,
                    const std::string& frame) {
  const auto above = frames.chain(options.frame_prefix + robot.links().front());
  return std::find(above.begin(), above.end(), frame_name(frame)) != above.end();
}

std::string mounted_frame(const MountOptions& options, const std::string& frame_of_images) {
  return std::string(frame_name(options.camera_frame.value_or(frame_of_images)));
}

std::optional<CameraMount> find_mount(const Robot& robot, const MountOptions& options,
                                      const FrameTree& frames, const std::string& frame_of_images) {
  if (options.parent) check_parent(robot, *options.parent);
  if (options.pose)
    return CameraMount{"", options.parent.value_or(robot.links().front()), *options.pose,
                       options.pose_source};
  const std::string frame = mounted_frame(options, frame_of_images);
  if (frame.empty())
    throw InputError("the images do not name their frame; give it with --camera-frame");
  if (options.parent)
    return CameraMount{frame, *options.parent, Eigen::Isometry3d::Identity(), "tf"};
  const std::string& prefix = options.frame_prefix;
  if (const std::string own = link_of(robot, prefix, frame); !own.empty())
    return CameraMount{"", own, Eigen::Isometry3d::Identity(), "a link of the robot"};
  for (const std::string& above : frames.chain(frame))
    if (const std::string link = link_of(robot, prefix, above); !link.empty())
      return CameraMount{frame, link, Eigen::Isometry3d::Identity(), "tf"};
  return std::nullopt;
}

std::string likely_prefix(const Robot& robot, const FrameTree& frames, const std::string& frame) {
  for (const std::string& above : frames.chain(frame))
    for (const std::string& link : robot.links()) {
      if (above.size() <= link.size() || !above.ends_with(link)) continue;
      std::string prefix = above.substr(0, above.size() - link.size());
      if (frames.knows(prefix + robot.links().front())) return prefix;
    }
  return {};
}

std::optional<TransformMessage> transform_of_mount(const Robot& robot,
                                                   const TransformBuffer& transforms,
                                                   const FrameTree& frames,
                                                   const MountOptions& options,
                                                   const CameraMount& mount) {
  const std::string& prefix = options.frame_prefix;
  std::string top = mount.frame;
  for (const std::string& above : frames.chain(mount.frame)) {
    if (!link_of(robot, prefix, above).empty() || is_above_robot(robot, options, frames, above))
      break;
    top = above;
  }
  if (!link_of(robot, prefix, top).empty()) return std::nullopt;
  TransformAnswer own;
  if (top != mount.frame) transforms.at(0, mount.frame, top, own);
  const bool is_fixed = own.status == TransformStatus::ok && own.is_static;
  return TransformMessage{.header = {0, prefix + mount.parent},
                          .child_frame_id = is_fixed ? top : mount.frame,
                          .T_parent_child = is_fixed ? mount.T_parent_camera * own.T_target_source
                                                     : mount.T_parent_camera};
}

CameraMount mount_by_root(const Robot& robot, const MountOptions& options,
                          const std::string& frame_of_images) {
  return {mounted_frame(options, frame_of_images), robot.links().front(),
          Eigen::Isometry3d::Identity(), "tf"};
}

}  // namespace penumbra::io
