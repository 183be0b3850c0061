// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/frame_tree.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/files/printable.hpp>
#include <io/ros/camera_info_message.hpp>

namespace penumbra::io {
namespace {

std::string prefix_of(const CameraEvidence& evidence) {
  return evidence.source.empty() ? "" : evidence.source + ": ";
}

Camera camera_of_images(const CameraEvidence& evidence, const InfoOfImages& use) {
  return camera_of(use.info, prefix_of(evidence) + use.info_topic,
                   evidence.is_rectified || is_called_rectified(use.image_topic));
}

void check_frames(const CameraEvidence& evidence) {
  const std::string& info = evidence.depth.info.header.frame_id;
  if (evidence.info_is_named || frame_name(evidence.depth_frame) == frame_name(info)) return;
  throw InputError(prefix_of(evidence) + evidence.depth.info_topic + " is of the frame '" +
                   printable(info) + "', the images of " + evidence.depth.image_topic + " of '" +
                   printable(evidence.depth_frame) +
                   "'; say which camera_info is theirs with --camera-info-topic");
}

}  // namespace

JudgedCameras judged_cameras(const CameraEvidence& evidence) {
  check_frames(evidence);
  Camera depth = camera_of_images(evidence, evidence.depth);
  depth.frame_id = evidence.depth_frame;
  if (!evidence.color) return {std::move(depth), std::nullopt, evidence.depth.info};
  Camera color = camera_of_images(evidence, *evidence.color);
  if (frame_name(color.frame_id) == frame_name(depth.frame_id))
    return {std::move(depth), std::nullopt, evidence.depth.info};
  return {std::move(color), std::move(depth), evidence.color->info};
}

bool is_same_camera(const CameraInfoMessage& a, const CameraInfoMessage& b) {
  return a.header.frame_id == b.header.frame_id && a.height == b.height && a.width == b.width &&
         a.distortion_model == b.distortion_model && a.d == b.d && a.k == b.k && a.r == b.r &&
         a.p == b.p && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi.x_offset == b.roi.x_offset && a.roi.y_offset == b.roi.y_offset &&
         a.roi.height == b.roi.height && a.roi.width == b.roi.width &&
         a.roi.do_rectify == b.roi.do_rectify;
}

bool is_called_rectified(const std::string& topic) {
  const std::string base = image_base(topic);
  return std::string_view(base).substr(base.rfind('/') + 1).starts_with("image_rect");
}

std::string image_base(const std::string& topic) {
  for (const std::string_view ending : {"/compressedDepth", "/compressed", "/foxglove"})
    if (topic.size() > ending.size() && topic.ends_with(ending))
      return topic.substr(0, topic.size() - ending.size());
  return topic;
}

}  // namespace penumbra::io
