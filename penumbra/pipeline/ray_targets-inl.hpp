// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// Judges a 3-D box, or a point with its radius, on a labelled scan with rays, as TargetJudge does,
/// each ray that meets it in place of a pixel. Rays without a measurement do not exist.
/// `T_points_frame`: from the target's frame. Throws InputError for other shapes.
[[nodiscard]] Judgement judge_on_rays(const Scan& scan, const LabelledImages& images,
                                      const Tolerance& tolerance, const Target& target,
                                      const Eigen::Isometry3d& T_points_frame,
                                      TargetMemory& memory);

}  // namespace penumbra
