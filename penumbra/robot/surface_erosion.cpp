// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/surface_erosion-inl.hpp>

namespace penumbra::offset {

TriangleMesh erode_surface(const TriangleMesh& /*welded*/, double depth) {
  throw InputError("a margin is " + std::to_string(-depth) + " m; it must be 0 or positive");
}

}  // namespace penumbra::offset
