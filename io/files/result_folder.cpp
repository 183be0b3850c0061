// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <system_error>
#include <utility>

#include <fnmatch.h>

#include <penumbra/base/error.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/result_folder.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw InputError(folder.string() + ": cannot be used as output folder (" + why +
                   "); choose another with -o");
}

/// Makes a folder. Returns false if it existed.
bool make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) refuse(folder, "it is a file");
  const bool made = fs::create_directories(folder, error);
  if (error) refuse(folder, error.message());
  return made;
}

bool starts_with(const fs::path& file, std::string_view start) {
  std::error_code error;
  InputFile input;
  if (fs::symlink_status(file, error).type() != fs::file_type::regular || !input.open(file).ok())
    return false;
  std::string found(start.size(), '\0');
  return input.read(found.data(), found.size()) == start.size() && found == start;
}

}  // namespace

ResultFolder::ResultFolder(ResultFolderOptions options)
    : options_(std::move(options)),
      is_made_(make_folder(path())),
      lock_(path()),
      has_former_(finds_former()) {
  refuse_links();
  if (options_.force) return;
  if (!has_former_ && holds_other_files())
    throw InputError(path().string() + ": holds files, and no " + options_.report.name +
                     " of penumbra; " + options_.advice);
  for (const ResultFile& result : options_.others)
    if (result.is_wanted && result.name.find('*') == std::string::npos) check_is_ours(result);
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  for (const auto& [kind, index] : frames_)
    fs::remove(options_.frames[kind].pattern.file(index), ignored);
  const bool is_failed = !parts_.empty();
  while (!parts_.empty()) parts_.erase(parts_.begin());  // the report's last
  if (is_failed && has_former_ && holds_other_files()) leave_part();
  if (is_made_) fs::remove(path(), ignored);
}

/// Leaves the mark of a killed command, so that the next one accepts the folder as this one did.
void ResultFolder::leave_part() const {
  try {
    write_file(PendingFile::part_of(path() / options_.report.name), nullptr, 0);
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): the next command refuses it
  }
}

bool ResultFolder::finds_former() const {
  const fs::path report = path() / options_.report.name;
  std::error_code error;
  return starts_with(report, options_.report.start) ||
         fs::is_regular_file(fs::symlink_status(PendingFile::part_of(report), error));
}

void ResultFolder::refuse_links() const {
  std::vector<fs::path> own;
  for (const std::string& name : options_.subfolders) own.push_back(path() / name);
  for (const FrameFiles& frames : options_.frames)
    own.push_back(frames.pattern.file(0).parent_path());
  std::error_code error;
  for (const fs::path& folder : own)
    if (fs::is_symlink(folder, error))
      refuse(folder, "it is a link, and nothing is written or removed behind one");
}

/// Returns whether there is more than the empty folders of a failed command.
bool ResultFolder::holds_other_files() const {
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(path(), error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (!fs::is_directory(entry->symlink_status(ignored))) return true;
    const auto& names = options_.subfolders;
    const bool is_own = std::ranges::find(names, entry->path().filename().string()) != names.end();
    if (is_own && entry.depth() == 0) entry.disable_recursion_pending();
  }
  return static_cast<bool>(error);
}

std::vector<fs::path> ResultFolder::files_of(const ResultFile& result) const {
  std::vector<fs::path> files;
  std::error_code error;
  fs::directory_iterator entry(path(), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (fnmatch(result.name.c_str(), name.c_str(), 0) == 0) files.push_back(entry->path());
  }
  return files;
}

void ResultFolder::check_is_ours(const ResultFile& result) const {
  for (const fs::path& file : files_of(result))
    if (!starts_with(file, result.start))
      throw InputError(file.string() + ": is no result of penumbra; move it away, or " +
                       options_.advice);
}

void ResultFolder::remove(const fs::path& file) const {
  std::error_code error;
  if (fs::remove(file, error); error)
    throw InputError(file.string() + ": of an earlier run, cannot be removed (" + error.message() +
                     "); " + options_.advice);
}

/// Without a former report, such files may be the user's.
void ResultFolder::remove_former_frames() const {
  if (!has_former_) return;
  for (const FrameFiles& frames : options_.frames) {
    const fs::path folder = frames.pattern.file(0).parent_path();
    std::error_code error, ignored;
    if (!fs::is_directory(folder, error)) continue;
    std::vector<fs::path> former;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
      if (frames.pattern.makes(entry->path().filename().string()) &&
          !fs::is_directory(entry->symlink_status(ignored)))
        former.push_back(entry->path());
    if (error) refuse(folder, error.message());
    for (const fs::path& file : former) remove(file);
  }
}

void ResultFolder::begin(std::span<const fs::path> inputs) {
  const auto is_used = [&](const fs::path& file) {
    std::error_code ignored;
    return !fs::is_symlink(file, ignored) && std::ranges::any_of(inputs, [&](const auto& input) {
      return fs::equivalent(file, input, ignored);
    });
  };
  const fs::path report = path() / options_.report.name;
  std::error_code error;
  if (fs::is_symlink(report, error)) remove(report);
  parts_.push_back(std::make_unique<PendingFile>(report));
  std::vector<ResultFile> all = {options_.report};
  all.insert(all.end(), options_.others.begin(), options_.others.end());
  for (const ResultFile& result : all) {
    std::vector<fs::path> former = files_of({PendingFile::part_of(result.name)});  // of killed ones
    std::erase(former, parts_.back()->part());
    for (const fs::path& file : files_of(result))
      if (starts_with(file, result.start) || fs::is_symlink(file, error)) former.push_back(file);
    std::erase_if(former, is_used);
    for (const fs::path& file : former) remove(file);
  }
  remove_former_frames();
  for (const FrameFiles& frames : options_.frames)
    if (frames.is_wanted) make_folder(frames.pattern.file(0).parent_path());
}

void ResultFolder::add_text(const std::string& name, std::string_view text) {
  add(name, [&](const fs::path& part) { write_file(part, text.data(), text.size()); });
}

fs::path ResultFolder::frame_file(std::size_t kind, std::int64_t index) {
  fs::path file = options_.frames[kind].pattern.file(index);
  remove(file);
  frames_.emplace_back(kind, index);
  return file;
}

void ResultFolder::finish() {
  for (const auto& part : parts_) part->finish();
  parts_.clear();
  frames_.clear();
}

}  // namespace penumbra::io
