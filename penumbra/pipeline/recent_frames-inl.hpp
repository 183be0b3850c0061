// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Where the robot and its camera were. Without links: unknown.
struct FramePoses {
  std::span<const Eigen::Isometry3d> T_root_link;
  std::span<const Eigen::Isometry3d> T_camera_link;
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  LinkDoubts doubts = {};

  [[nodiscard]] bool known() const { return !T_root_link.empty(); }
};

/// One frame as targets are judged on it.
struct JudgedFrame {
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  FrameStatus status = FrameStatus::ok;
  std::string_view message;  ///< of a status that is not ok
  FramePoses poses;
  DepthView depth;      ///< the camera's image; empty where there is none that can be used
  JudgedImages images;  ///< empty where targets cannot be judged
};

/// The last frames: their poses, and for a span of time their depth, so that they can be labelled
/// again. Keeps its buffers.
class RecentFrames {
 public:
  static constexpr std::size_t max_frames = 128;
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;  // 580 images of 1280x720, 16 bit

  /// `links`: of the robot. `span`: nanoseconds that depth is kept for; 0: none is.
  RecentFrames(std::size_t links, std::int64_t span);

  /// In place of a frame of the same stamp. A frame without stamp is not kept.
  void keep(const JudgedFrame& frame);

  /// The frame of exactly that stamp, without depth and images; nothing if there is none. Valid
  /// until the next keep().
  [[nodiscard]] std::optional<JudgedFrame> find(std::int64_t stamp) const;

  /// With its depth, if it had any; nothing where that is gone.
  [[nodiscard]] std::optional<JudgedFrame> find_with_depth(std::int64_t stamp) const;

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
