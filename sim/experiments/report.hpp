// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <sim/experiments/results.hpp>

namespace penumbra::sim {

/// Writes metrics.json and report.html into a folder. Throws InputError where it cannot.
void write_report(const ExperimentResult& result, const std::filesystem::path& folder);

/// Settings, each method's measures over all seeds with confidence, and each seed's.
[[nodiscard]] std::string metrics_json(const ExperimentResult& result);

/// One file with everything in it: styles, plots, pictures.
[[nodiscard]] std::string report_html(const ExperimentResult& result);

}  // namespace penumbra::sim
