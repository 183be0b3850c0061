// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tiny_bag.hpp"

#include <filesystem>

#include <Eigen/Geometry>

namespace penumbra::test {

/// Returns the frames of a recording folder as its robot and camera would publish them: joint
/// states, depth (/camera/depth/image) and colour (/camera/color/image), if there is any, with the
/// stamps of the frames, which need them; and the frame "camera_optical_frame" of both at this pose
/// on the camera's link, in tf_static.
[[nodiscard]] TinyBag recording_bag(const std::filesystem::path& folder,
                                    const Eigen::Isometry3d& T_parent_camera);

}  // namespace penumbra::test
