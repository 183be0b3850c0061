// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/occlusion/target_judge.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// Where the robot and its camera were. Without links: unknown.
struct FramePoses {
  std::span<const Eigen::Isometry3d> T_root_link;
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  LinkDoubts doubts = {};

  [[nodiscard]] bool known() const { return !T_root_link.empty(); }
};

/// One frame as targets are judged on it.
struct JudgedFrame {
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  FrameStatus status = FrameStatus::ok;
  std::string_view message;  ///< of a status that is not ok
  JudgedImages images;       ///< empty where targets cannot be judged
  FramePoses poses;
};

/// A copy of a frame's doubts.
class KeptDoubts {
 public:
  void keep(const LinkDoubts& doubts) {
    links_.assign(doubts.links.begin(), doubts.links.end());
    why_ = doubts.why;
  }
  [[nodiscard]] LinkDoubts view() const { return {links_, why_}; }

 private:
  std::vector<std::size_t> links_;
  std::string why_;
};

/// The poses of the last frames.
class RecentPoses {
 public:
  static constexpr std::size_t frames = 128;

  explicit RecentPoses(std::size_t links);

  void keep(std::int64_t stamp, const FramePoses& poses);  ///< known ones
  [[nodiscard]] std::optional<FramePoses> find(std::int64_t stamp) const;
  void clear();

 private:
  struct Entry {
    std::optional<std::int64_t> stamp;
    Eigen::Isometry3d T_root_camera;
    KeptDoubts doubts;
  };
  [[nodiscard]] std::span<const Eigen::Isometry3d> links_of(std::size_t entry) const;

  std::size_t links_;
  std::array<Entry, frames> entries_;
  std::vector<Eigen::Isometry3d> T_root_link_;  // of entry after entry
  std::size_t next_ = 0;
};

/// Copies of the last frames' images. Holds its buffers, as many as the span needs, up to both
/// limits.
class RecentFrames {
 public:
  static constexpr std::size_t max_frames = 1024;
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;  // 105 frames of 1280x720

  /// `span`: nanoseconds that frames are kept for; 0: none is.
  explicit RecentFrames(std::int64_t span) : span_(span) {}

  /// Copies a frame, in place of one of the same stamp. Of the virtual depth and the labels it
  /// copies the touched tiles.
  void keep(const JudgedFrame& frame);

  /// The frame of exactly that stamp; null if there is none. Valid until the next keep().
  [[nodiscard]] const JudgedFrame* find(std::int64_t stamp) const;

  [[nodiscard]] bool any() const { return span_ > 0; }
  void clear();

 private:
  /// A frame and the pixels that it shows.
  struct Copy {
    JudgedFrame frame;
    std::string message;
    std::vector<Eigen::Isometry3d> T_root_link;
    KeptDoubts doubts;
    Image<std::uint8_t> labels;
    Image<float> depth;
    Image<std::uint16_t> links;
    TileMask touched;         // of depth and links
    TileMask labels_touched;  // everything where labels come without a mask
    Image<std::uint16_t> millimetres;
    Image<float> metres;
  };

  [[nodiscard]] Copy& place_for(std::int64_t stamp);
  void copy_images(const JudgedImages& from, Copy& to);
  void copy_virtual_depth(const VirtualDepthView& from, Copy& to);

  std::int64_t span_;
  std::size_t pixels_ = 1;   // of a frame: the most so far
  std::deque<Copy> copies_;  // views of theirs stay valid as their number grows
  TileMask everything_;
  TileMask left_;  // of a copy's tiles, while it is written anew
};

}  // namespace penumbra
