// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <io/cloud/cloud_summary.hpp>
#include <io/files/json-inl.hpp>

namespace penumbra::io {

/// Returns numbers of points by the names of their labels.
[[nodiscard]] Json counts_by_label(const std::array<std::size_t, label_count>& points);

/// Returns one of "clouds" of report.json. `fault`: in place of the report's message, if not empty.
[[nodiscard]] Json cloud_frame_json(const CloudReport& report, std::uint64_t index,
                                    const std::string& fault);

/// Returns "summary" of report.json.
[[nodiscard]] Json cloud_summary_json(const CloudSummary& summary);

}  // namespace penumbra::io
