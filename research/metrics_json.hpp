// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <research/seed_run.hpp>

namespace penumbra::research {

/// Returns the text of metrics.json: settings, and each method's measures over all seeds, with
/// confidence, and of each seed.
[[nodiscard]] std::string metrics_json(const ExperimentResult& result);

}  // namespace penumbra::research
