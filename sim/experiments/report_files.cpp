// SPDX-License-Identifier: Apache-2.0
#include <system_error>

#include <penumbra/base/error.hpp>

#include <sim/experiments/report.hpp>

namespace penumbra::sim {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError("-o: " + file.string() + " cannot be written");
}

}  // namespace

ReportFiles::ReportFiles(const std::filesystem::path& folder)
    : files_{{{folder / "metrics.json", {}, metrics_json},
              {folder / "report.html", {}, report_html}}} {
  for (Opened& one : files_) {
    one.file.open(one.path, std::ios::binary);
    if (one.file) continue;
    remove_all();
    refuse(one.path);
  }
}

ReportFiles::~ReportFiles() {
  if (!is_written_) remove_all();
}

void ReportFiles::write(const ExperimentResult& result) {
  for (Opened& one : files_)
    if (!(one.file << one.text(result)) || !one.file.flush()) refuse(one.path);
  is_written_ = true;
}

void ReportFiles::remove_all() {
  std::error_code ignored;
  for (Opened& one : files_)
    if (one.file.is_open()) std::filesystem::remove(one.path, ignored);
}

}  // namespace penumbra::sim
