// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <sim/experiments/report.hpp>

namespace penumbra::sim {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError("-o: " + file.string() + " cannot be written");
}

}  // namespace

ReportFiles::Opened::Opened(const std::filesystem::path& path_of_it,
                            std::string (*write)(const ExperimentResult&))
    : path(path_of_it), pending(path), file(pending.part(), std::ios::binary), text(write) {
  if (!file) refuse(path);
}

ReportFiles::ReportFiles(const std::filesystem::path& folder)
    : files_{Opened(folder / "metrics.json", metrics_json),
             Opened(folder / "report.html", report_page)} {}

void ReportFiles::write(const ExperimentResult& result) {
  for (Opened& one : files_) {
    one.file << one.text(result);
    one.file.close();
    if (!one.file) refuse(one.path);
  }
  for (Opened& one : files_) one.pending.finish();
}

}  // namespace penumbra::sim
