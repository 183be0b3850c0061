// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/files/view_planning_report.hpp>

namespace penumbra::io {

/// Returns report.html: one page with the best sets, and heat maps of what each candidate sees of
/// each target, over all frames and over time.
[[nodiscard]] std::string view_planning_page(const ViewPlan& plan);

}  // namespace penumbra::io
