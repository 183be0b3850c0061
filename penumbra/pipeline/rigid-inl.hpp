// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace penumbra {

/// Whether a transform is a finite rotation (to 1e-4, as for rotations in files) and translation.
[[nodiscard]] bool is_rigid(const Eigen::Isometry3d& T);

}  // namespace penumbra
