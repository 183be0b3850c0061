// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <penumbra/pipeline/target.hpp>

#include <io/files/json-inl.hpp>
#include <io/files/statistics.hpp>

namespace penumbra::io {

/// A frame's target in report.json; `links`: names that blame refers to.
[[nodiscard]] Json target_json(const TargetReport& target, std::span<const std::string> links);

/// What the summary says of a target.
[[nodiscard]] Json target_summary_json(const TargetStatistics& target);

}  // namespace penumbra::io
