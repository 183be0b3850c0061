// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// What tuning needs of a frame.
struct TuningFrame {
  std::size_t index = 0;
  Image<float> depth;          ///< measured, metres; 0: no measurement
  Image<float> virtual_depth;  ///< metres; 0: no robot on the ray
  Image<std::uint16_t> links;  ///< of virtual_depth: link index + 1; 0: none
  std::vector<Eigen::Isometry3d> T_camera_link;
};

/// Chooses frames of a recording between which the robot moves. Keeps at most `most` of them,
/// spread over the whole recording.
class TuningFrames {
 public:
  static constexpr std::size_t least = 3;
  static constexpr std::size_t most = 32;
  static constexpr double least_motion = 0.02;  ///< metres that one link moves, at least

  /// `range`: depths outside of it are no measurements.
  explicit TuningFrames(const DepthRange& range) : range_(range) {}

  /// Keeps the frame if it is good and the robot's pose differs from that of every kept frame. May
  /// drop earlier frames. Throws InputError if the camera moves relative to the robot's root.
  void add(const FrameReport& report);

  [[nodiscard]] std::span<const TuningFrame> frames() const { return frames_; }
  [[nodiscard]] bool holds(std::size_t index) const;

  /// Throws InputError if fewer than `least` frames are kept.
  void check() const;

 private:
  [[nodiscard]] bool differs(const TuningFrame& frame, std::span<const TuningFrame> from) const;
  void thin();

  DepthRange range_;
  double motion_ = least_motion;
  std::size_t seen_ = 0, good_ = 0;  // frames
  std::string fault_;                // of the first frame that is not good
  std::optional<Eigen::Isometry3d> T_root_camera_;
  std::vector<TuningFrame> frames_;
};

}  // namespace penumbra
