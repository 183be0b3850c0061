// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <io/disk_file.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

/// How every report begins (io::ReportWriter).
constexpr std::string_view report_start = "{\"penumbra\": ";

/// Whether a run could have written a file of this name: digits and an image's ending.
bool is_frame_file(const fs::path& file) {
  const std::string stem = file.stem().string();
  const bool digits =
      stem.size() >= frame_digits &&
      std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits && (file.extension() == ".png" || file.extension() == ".npy");
}

/// The link where `file` is one: what it leads to is not of a run.
void remove_file(const fs::path& file) {
  std::error_code error;
  if (fs::remove(file, error); error)
    throw InputError(file.string() + ": of an earlier run, cannot be removed (" + error.message() +
                     "); choose another folder with -o");
}

/// The frames' images in a folder, of whatever origin.
std::vector<fs::path> frame_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error, ignored;
  if (!fs::is_directory(folder, error)) return files;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (is_frame_file(entry->path()) && fs::is_regular_file(entry->path(), ignored))
      files.push_back(entry->path());
  if (error)
    throw InputError(folder.string() + ": cannot be listed (" + error.message() +
                     "); choose another folder with -o");
  return files;
}

/// The images that stand where a run writes its own.
std::vector<fs::path> images_in(const fs::path& output) {
  std::vector<fs::path> images;
  for (const char* const kind : {"vdi", "labels", "links", "overlay"}) {
    const fs::path folder = output / kind;
    const std::vector<fs::path> found = frame_files(folder);
    std::error_code ignored;
    if (!found.empty() && fs::is_symlink(folder, ignored))
      throw InputError(folder.string() + ": leads to a folder with " +
                       found.front().filename().string() +
                       ", and nothing behind a link is removed; empty that folder, or choose "
                       "another one with -o");
    images.insert(images.end(), found.begin(), found.end());
  }
  return images;
}

/// Whether a run's report stands there. `is_part`: it may not have got to its first bytes.
/// Throws InputError where the file is another's.
bool has_report(const fs::path& file, bool is_part) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::array<char, report_start.size()> start{};
  io::InputFile input;
  input.open(file).require();
  const std::string_view text(start.data(), input.read(start.data(), start.size()));
  if (text != report_start && !(is_part && text.empty()))
    throw InputError(file.string() +
                     ": is no report of penumbra, whose own would take its place; move it away, or "
                     "choose another folder with -o");
  return true;
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
  const fs::path part = report.string() + ".part";
  if (fs::is_directory(report, error))
    throw InputError(report.string() +
                     ": is a folder where the report is to be written; remove it, or choose "
                     "another output folder with -o");
  const bool has_whole = has_report(report, false);
  const bool has_part = has_report(part, true);
  const std::vector<fs::path> images = images_in(folder);
  if (!images.empty() && !has_whole && !has_part)
    throw InputError(images.front().string() +
                     ": is of no run of penumbra, as there is no report.json, and stands where "
                     "images are written; move it away, or choose another folder with -o");
  // Until the last image is gone a report says whose they are, but none as of a whole run.
  if (has_whole) fs::rename(report, part, error);
  const bool is_renamed = has_whole && !error;
  if (has_whole && error) remove_file(report);
  for (const fs::path& image : images) remove_file(image);
  if (is_renamed || has_part) remove_file(part);
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

UnfinishedRun::~UnfinishedRun() {
  if (finished_) return;
  try {
    for (const fs::path& image : images_in(folder_)) remove_file(image);
  } catch (const InputError&) {
    // What made the run fail is told, and the next run names what stayed.
  }
}

}  // namespace penumbra::app
