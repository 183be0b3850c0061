// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/files/camera_views.hpp>

namespace penumbra::io {

/// Returns the report.html of several cameras: for each target the counts of its verdicts, and over
/// time the verdict over all cameras above each camera's own. Names of cameras are links to their
/// reports, NAME/report.html.
[[nodiscard]] std::string camera_views_page(const CameraViews& views);

}  // namespace penumbra::io
