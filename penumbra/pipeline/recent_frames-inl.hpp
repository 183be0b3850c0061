// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/labelled_frame-inl.hpp>

namespace penumbra {

/// The last frames: their poses, and for a span of time their depth, so that they can be labelled
/// again. Keeps its buffers.
class RecentFrames {
 public:
  static constexpr std::size_t max_frames = 128;
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;  // 580 images of 1280x720, 16 bit

  /// `links`: of the robot. `span`: nanoseconds that depth is kept for; 0: none is.
  RecentFrames(std::size_t links, std::int64_t span);

  /// In place of a frame of the same stamp. A frame without stamp is not kept.
  void keep(const LabelledFrame& frame);

  /// The poses, or the depth image, of the frame of exactly that stamp; nothing if it is not kept.
  /// Valid until the next keep().
  [[nodiscard]] std::optional<PoseResult> poses_at(std::int64_t stamp) const;
  [[nodiscard]] std::optional<DepthView> depth_at(std::int64_t stamp) const;

  [[nodiscard]] bool keeps_depth() const { return span_ > 0; }
  void clear();

 private:
  struct Kept {
    std::optional<std::int64_t> stamp;
    FrameStatus status = FrameStatus::ok;
    std::string message;
    std::vector<Eigen::Isometry3d> T_root_link, T_camera_link;
    Eigen::Isometry3d T_root_camera;
    std::vector<std::size_t> doubted_links;
    std::string why_doubted;
  };
  struct KeptDepth {
    std::optional<std::int64_t> stamp;
    DepthView view;  // of one of the two; empty where the frame had none
    Image<std::uint16_t> millimetres;
    Image<float> metres;
  };

  [[nodiscard]] Kept& place_for(std::int64_t stamp);
  [[nodiscard]] KeptDepth& depth_place_for(std::int64_t stamp, std::size_t bytes);

  std::int64_t span_;
  std::vector<Kept> frames_;
  std::size_t next_ = 0;          // of frames_ to be replaced
  std::deque<KeptDepth> depths_;  // views of theirs stay valid as their number grows
};

}  // namespace penumbra
