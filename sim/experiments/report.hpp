// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <io/pending_file.hpp>
#include <sim/experiments/results.hpp>

namespace penumbra::sim {

/// metrics.json and report.html of a folder. They are opened under other names before the runs, so
/// that a folder that cannot be written costs no time; former ones stay until both are written.
class ReportFiles {
 public:
  /// Throws InputError where they cannot be opened.
  explicit ReportFiles(const std::filesystem::path& folder);

  /// Throws InputError where it cannot.
  void write(const ExperimentResult& result);

 private:
  struct Opened {
    Opened(const std::filesystem::path& path_of_it, std::string (*write)(const ExperimentResult&));
    std::filesystem::path path;
    io::PendingFile pending;
    std::ofstream file;
    std::string (*text)(const ExperimentResult&);
  };

  std::array<Opened, 2> files_;
};

/// Settings, each method's measures over all seeds with confidence, and each seed's.
[[nodiscard]] std::string metrics_json(const ExperimentResult& result);

/// The page: metrics_json(), what was compared, the first seed over time, and pictures.
[[nodiscard]] std::string report_page(const ExperimentResult& result);

}  // namespace penumbra::sim
