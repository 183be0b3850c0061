// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/calibration/kept_frames.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// How far measured depths lie from the virtual ones inside the robot's outline.
struct ToleranceFit {
  Tolerance tolerance;            ///< recommended; b is 0
  std::size_t pixels = 0;         ///< that were compared
  double bias = 0.0;              ///< median of measured minus virtual depth, metres
  double false_front_now = 0.0;   ///< share of the robot's pixels that are front, current rule
  double false_front_then = 0.0;  ///< the same with the recommended one
};

/// How far the sensor carries the robot's depth past the outline.
struct FringeFit {
  static constexpr int farthest = 80;  ///< pixels; the largest candidate
  static constexpr int step = 4;       ///< pixels between two candidates

  enum Shown : std::uint8_t { nothing, removed, left };

  int reach = 0;  ///< recommended, pixels: the smallest that leaves no more than the default's
  double median = 0.0, percent_90 = 0.0, percent_99 = 0.0;  ///< pixels
  std::size_t checked = 0;  ///< measured pixels up to 40 px from the outline of moving links
  std::size_t found = 0;    ///< of these: within 10 cm of the outline's virtual depth
  /// By reach / step: `found` that are not fringe, as a share of the arm's measured points, with
  /// the recommended tolerance and the extra parts drawn.
  std::vector<double> left_over;
  std::size_t shown_frame = 0;  ///< number among the frames, with the most fringe
  Image<std::uint8_t> shown;    ///< its pixels: Shown, by the recommended rule
};

/// What a link carries and the URDF lacks, as far as the camera saw it.
struct ExtraPart {
  std::size_t link = 0;
  std::vector<Eigen::AlignedBox3d> boxes;  ///< of each connected piece, in the link's frame, metres
  TriangleMesh mesh;                       ///< in the link's frame, metres
};

struct Tuning {
  LabelRule rule;  ///< recommended
  ToleranceFit tolerance;
  FringeFit fringe;
  std::vector<ExtraPart> extras;  ///< one for each link that has any
};

constexpr std::size_t most_tuning_frames = 32;

/// Measures a sensor in up to most_tuning_frames frames with depth, virtual depth and links, of a
/// camera that does not move relative to the robot's root. `camera` is a pinhole camera whose
/// images the frames are, `robot` what was drawn, `current` the rule in use. Throws InputError if
/// the frames show too little.
[[nodiscard]] Tuning tune(std::span<const KeptFrame> frames, const Intrinsics& camera,
                          const Robot& robot, const LabelRule& current);

}  // namespace penumbra
