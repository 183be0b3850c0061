// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stereo_camera.hpp"

#include <penumbra/labels/labels.hpp>

namespace penumbra::study {

/// Left image, true depth, measured depth and labels of one capture, two by two.
[[nodiscard]] Image<io::Rgb8> picture(const StereoImages& images, const LabelView& labels);

}  // namespace penumbra::study
