// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/camera/camera.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Returns the camera of a message, by the rules of read_camera_info. `source`: the topic. Throws
/// InputError that names source and field.
[[nodiscard]] Camera camera_of(const CameraInfoMessage& info, const std::string& source,
                               bool rectified);

}  // namespace penumbra::io
