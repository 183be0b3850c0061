// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/occlusion/target.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/png.hpp>

namespace penumbra::io {

/// The colour that stands for a verdict; told apart by people with any common colour blindness.
[[nodiscard]] Rgb8 verdict_color(Verdict verdict);

/// Names of targets that are drawn; of more, only the outlines are.
inline constexpr std::size_t max_target_names = 40;

/// Draws the outlines of a frame's targets in their verdicts' colours, with name and verdict, and a
/// cross where a handled one is. `camera`: of the report's images, which `out` has the size of.
void draw_targets(std::span<const Target> targets, const FrameReport& report, const Robot& robot,
                  const Camera& camera, Image<Rgb8>& out);

}  // namespace penumbra::io
