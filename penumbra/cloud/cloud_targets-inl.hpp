// SPDX-License-Identifier: Apache-2.0
// Targets on the rays of a labelled scan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include <penumbra/cloud/cloud_labels.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra::cloud {

struct LabelledRays {
  PointsView points;
  Eigen::Vector3d origin;
  std::span<const std::uint8_t> labels;
  std::span<const std::uint16_t> links;
  std::size_t link_count;
  Tolerance tolerance;
};

/// Judges a 3-D box, or a point with its radius, as TargetJudge does, each ray that meets it in
/// place of a pixel. Rays without a measurement do not exist. `T_points_frame`: from the target's
/// frame. Throws InputError for other shapes.
[[nodiscard]] Judgement judge_on_rays(const LabelledRays& rays, const Target& target,
                                      const Eigen::Isometry3d& T_points_frame,
                                      TargetMemory& memory);

}  // namespace penumbra::cloud
