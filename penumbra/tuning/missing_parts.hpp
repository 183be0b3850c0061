// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Finds moving links that carry something large that the URDF lacks. Stereo matching leaves most
/// of the fringe near the robot's outline; an undescribed part extends to the fringe's reach, and
/// moves with its link: what stands still next to a link is left out.
class MissingParts {
 public:
  /// A link is named if in half of the frames, two or more, over `most` of the fringe pixels next
  /// to it are farther from the outline than `far` times the fringe's reach. On a real recording
  /// complete links exceed `most` in at most one frame; where a part of 10 cm is missing, in half.
  static constexpr double far = 0.6;
  static constexpr double most = 0.15;
  /// Pixels of fringe in a frame; less is too little to judge a link by.
  static constexpr std::size_t least_fringe = 200;

  /// `fringe_reach`: of the label rule, pixels.
  MissingParts(const Robot& robot, int fringe_reach);

  /// Measures the first, second, fourth, eighth, ... frame with fringe, each in some milliseconds.
  void add(const FrameReport& report);

  /// One line for each such link.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  struct Link {
    Eigen::Isometry3d first_pose = Eigen::Isometry3d::Identity();  // in the root link's frame
    bool has_moved = false;
  };
  /// A fringe pixel far from the outline.
  struct Far {
    std::size_t frame, link;  // index into measured_; index of the link
    int u, v;                 // of the small image
  };
  /// A measured frame.
  struct Measured {
    Image<float> depth;  // every fourth pixel; 0: robot, or not measured
    Eigen::Isometry3d T_root_camera;
    std::vector<Eigen::Isometry3d> T_root_link;
    std::vector<std::size_t> fringe;  // pixels next to each link
  };

  void measure(const FrameReport& report);
  /// Whether another frame shows the same there although the link was elsewhere.
  [[nodiscard]] bool stands_still(const Far& pixel) const;

  Robot robot_;
  double far_;  // pixels
  std::size_t frames_ = 0;
  std::vector<Link> links_;
  std::vector<Measured> measured_;
  std::vector<Far> far_fringe_;
};

}  // namespace penumbra
