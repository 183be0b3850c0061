// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <sim/experiments/results.hpp>

namespace penumbra::sim {

/// metrics.json and report.html of a folder. They are opened, and former ones emptied, before the
/// runs, so that a folder that cannot be written costs no time; what is not written in the end is
/// removed.
class ReportFiles {
 public:
  /// Throws InputError where they cannot be opened.
  explicit ReportFiles(const std::filesystem::path& folder);
  ~ReportFiles();
  ReportFiles(const ReportFiles&) = delete;
  ReportFiles& operator=(const ReportFiles&) = delete;

  /// Throws InputError where it cannot.
  void write(const ExperimentResult& result);

 private:
  struct Opened {
    std::filesystem::path path;
    std::ofstream file;
    std::string (*text)(const ExperimentResult&);
  };
  void remove_all();

  std::array<Opened, 2> files_;
  bool is_written_ = false;
};

/// Settings, each method's measures over all seeds with confidence, and each seed's.
[[nodiscard]] std::string metrics_json(const ExperimentResult& result);

/// One file with everything in it: styles, plots, pictures.
[[nodiscard]] std::string report_html(const ExperimentResult& result);

}  // namespace penumbra::sim
