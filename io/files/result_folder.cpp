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
    : options_(std::move(options)), is_made_(make_folder(path())), lock_(path()) {
  if (options_.force) return;
  if (!has_former() && holds_other_files())
    throw InputError(path().string() + ": holds files, and no " + options_.report.name +
                     " of penumbra; " + options_.advice);
  for (const ResultFile& result : options_.others)
    if (result.is_wanted && result.name.find('*') == std::string::npos) check_is_ours(result);
}

ResultFolder::~ResultFolder() {
  parts_.clear();
  std::error_code ignored;
  if (is_made_) fs::remove(path(), ignored);
}

bool ResultFolder::has_former() const {
  const fs::path report = path() / options_.report.name;
  std::error_code error;
  return starts_with(report, options_.report.start) ||
         fs::exists(PendingFile::part_of(report), error);
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

void ResultFolder::remove_former(std::span<const fs::path> inputs) const {
  std::vector<ResultFile> all = options_.others;
  all.push_back(options_.report);
  std::error_code error;
  const auto is_used = [&](const fs::path& file) {
    return std::ranges::any_of(inputs, [&](const fs::path& input) {
      std::error_code ignored;
      return fs::equivalent(file, input, ignored);
    });
  };
  for (const ResultFile& result : all) {
    std::vector<fs::path> former = files_of({PendingFile::part_of(result.name)});  // of killed ones
    for (const fs::path& file : files_of(result))
      if (starts_with(file, result.start) || fs::is_symlink(file, error)) former.push_back(file);
    std::erase_if(former, is_used);
    for (const fs::path& file : former)
      if (fs::remove(file, error); error)
        throw InputError(file.string() + ": of an earlier run, cannot be removed (" +
                         error.message() + "); " + options_.advice);
  }
}

void ResultFolder::add_text(const std::string& name, std::string_view text) {
  add(name, [&](const fs::path& part) { write_file(part, text.data(), text.size()); });
}

void ResultFolder::finish() {
  for (const auto& part : parts_) part->finish();
  parts_.clear();
}

}  // namespace penumbra::io
