// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <io/disk_file.hpp>
#include <io/web/report_page.hpp>

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
  return digits && (file.extension() == ".png" || file.extension() == ".npy" ||
                    file.extension() == ".pcd" || file.extension() == ".ply");
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
  for (const char* const kind : {"vdi", "labels", "links", "overlay", "filtered", "points"}) {
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

/// A regular file's first bytes; nothing where there is none.
std::optional<std::string> start_of(const fs::path& file, std::size_t size) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::string start(size, '\0');
  io::InputFile input;
  input.open(file).require();
  start.resize(input.read(start.data(), start.size()));
  return start;
}

[[noreturn]] void refuse_foreign(const fs::path& file) {
  throw InputError(file.string() +
                   ": is no report of penumbra, whose own would take its place; move it away, or "
                   "choose another folder with -o");
}

/// Whether a run's report stands there. `is_part`: it may not have got to its first bytes.
/// Throws InputError where the file is another's.
bool is_report(const fs::path& file, bool is_part) {
  const auto start = start_of(file, report_start.size());
  if (start && *start != report_start && !(is_part && start->empty())) refuse_foreign(file);
  return start.has_value();
}

/// Whether a run's page stands there, and not an experiment's, for one.
bool is_page(const fs::path& file) {
  return start_of(file, io::report_page_start.size()) == io::report_page_start;
}

/// What an earlier run left in a folder.
struct FormerRun {
  fs::path report, part, page;
  bool has_report = false, has_part = false, has_page = false;
  std::vector<fs::path> images;
};

FormerRun find_former_run(const fs::path& folder) {
  std::error_code error;
  FormerRun former{.report = folder / "report.json",
                   .part = folder / "report.json.part",
                   .page = folder / "report.html",
                   .images = {}};
  const fs::file_status found = fs::status(folder, error);
  if (!fs::exists(found)) return former;
  if (!fs::is_directory(found))
    throw InputError(folder.string() +
                     ": cannot be used as output folder (it is a file); choose another with -o");
  if (fs::is_directory(former.report, error))
    throw InputError(former.report.string() +
                     ": is a folder where the report is to be written; remove it, or choose "
                     "another output folder with -o");
  former.has_report = is_report(former.report, false);
  former.has_part = is_report(former.part, true);
  former.has_page = is_page(former.page);
  former.images = images_in(folder);
  if (!former.images.empty() && !former.has_report && !former.has_part)
    throw InputError(former.images.front().string() +
                     ": is of no run of penumbra, as there is no report.json, and stands where "
                     "images are written; move it away, or choose another folder with -o");
  return former;
}

}  // namespace

void check_former_run(const fs::path& folder) { static_cast<void>(find_former_run(folder)); }

void check_former_page(const fs::path& folder) {
  const fs::path page = folder / "report.html";
  std::error_code error;
  if (fs::exists(page, error) && !is_page(page)) refuse_foreign(page);
}

void remove_former_run(const fs::path& folder) {
  const FormerRun former = find_former_run(folder);
  std::error_code error;
  // Until the last image is gone a report says whose they are, but none as of a whole run.
  if (former.has_report) fs::rename(former.report, former.part, error);
  const bool is_renamed = former.has_report && !error;
  if (former.has_report && error) remove_file(former.report);
  if (former.has_page) remove_file(former.page);
  for (const fs::path& image : former.images) remove_file(image);
  if (is_renamed || former.has_part) remove_file(former.part);
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
