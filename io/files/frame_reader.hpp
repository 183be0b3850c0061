// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/recording.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::io {

/// Returns the pose of a joint row, with what is attached in its frame. `camera_parent`: the link
/// that carries the camera, without which there is no pose.
[[nodiscard]] RobotPose pose_of(const JointRow& row, const Robot& robot, std::size_t camera_parent,
                                std::span<const RecordedBody> bodies);

/// Reads a recording's frames. Faults of a frame's data become its status and are never thrown.
class FrameReader {
 public:
  /// Reads the joint file, lists the depth images and opens videos. Keeps neither argument. Throws
  /// InputError as read_joint_file, FramePattern::existing and VideoFile.
  FrameReader(const Recording& recording, const Robot& robot);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::int64_t index(std::size_t i) const { return rows_[i].index; }

  /// Reads the i-th frame in the order of the joint file. Depth images (without a depth camera:
  /// colour images) without a row are frames
  /// with status missing_joints, before the first row of a later frame. The depth image is read
  /// even if the joints are missing. Images are owned by the frame. Several threads may call this.
  [[nodiscard]] Frame read(std::size_t i, bool with_color) const;
  [[nodiscard]] bool has_depth() const { return files_.depth.has_value(); }

 private:
  class DepthCamera;
  [[nodiscard]] std::vector<std::int64_t> numbers_of_images() const;
  [[nodiscard]] FileResult read_depth_image(std::int64_t index, SharedDepth& depth) const;
  [[nodiscard]] FileResult read_color_image(std::int64_t index, SharedColor& color) const;

  ImageSize size_;
  RecordingFrames files_;
  std::shared_ptr<VideoFile<std::uint16_t>> depth_video_;  // in place of depth images
  std::shared_ptr<VideoFile<Rgb8>> color_video_;
  std::shared_ptr<DepthCamera> depth_camera_;  // null: depth images are the camera's
  std::optional<double> depth_scale_;          // metres per unit; null: the format's
  Image<float> z_of_ray_;                      // of a metre along each pixel's ray; empty: not used
  std::vector<JointRow> rows_;
  std::vector<RecordedBody> bodies_;
  Robot robot_;
  std::size_t camera_parent_;
};

}  // namespace penumbra::io
