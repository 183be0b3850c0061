// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

void Camera::check() const {
  if (range.near >= 0 && range.near < range.far) return;
  std::ostringstream what;
  what << "camera: range near = " << range.near << ", far = " << range.far
       << " metres must be 0 <= near < far";
  throw InputError(what.str());
}

}  // namespace penumbra
