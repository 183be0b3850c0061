// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <system_error>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <io/disk_file.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

/// Whether a run could have written a file of this name: digits and an image's ending.
bool is_frame_file(const fs::path& file) {
  const std::string stem = file.stem().string();
  const bool digits =
      stem.size() >= frame_digits &&
      std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits && (file.extension() == ".png" || file.extension() == ".npy");
}

void remove_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  if (fs::remove(file, error); error)
    throw InputError(file.string() + ": of an earlier run, cannot be removed (" + error.message() +
                     "); choose another folder with -o");
}

void remove_frames(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (is_frame_file(entry->path())) remove_file(entry->path());
  if (error)
    throw InputError(folder.string() + ": cannot be listed (" + error.message() +
                     "); choose another folder with -o");
}

}  // namespace

void remove_former_run(const fs::path& folder) {
  std::error_code error;
  const fs::file_status found = fs::status(folder, error);
  if (!fs::exists(found)) return;
  if (!fs::is_directory(found))
    throw InputError(folder.string() +
                     ": cannot be used as output folder (it is a file); choose another with -o");
  const fs::path report = folder / "report.json";
  if (fs::is_directory(report, error))
    throw InputError(report.string() +
                     ": is a folder where the report is to be written; remove it, or choose "
                     "another output folder with -o");
  remove_file(report);
  remove_file(report.string() + ".part");
  for (const char* const kind : {"vdi", "labels", "links", "overlay"}) remove_frames(folder / kind);
}

void remove_former_file(const std::string& option, const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw InputError(option + ": " + file.string() + " is a folder; the name of a file is wanted");
  if (!fs::is_regular_file(file, error)) return;
  // Behind a link, as that is what will be written. Where a folder lets no name go, its content
  // goes.
  if (fs::remove(fs::canonical(file, error), error); error) io::OutputFile(file).close();
}

}  // namespace penumbra::app
