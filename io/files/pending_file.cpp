// SPDX-License-Identifier: Apache-2.0
#include <system_error>

#include <io/files/pending_file.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // Linux follows no more either

/// Where a chain of links ends, whether or not anything is there.
fs::path behind_links(fs::path file) {
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(file, error); ++i)
    file = file.parent_path() / fs::read_symlink(file, error);
  return file;
}

/// Whether `file` is there and no regular file that has the name `found`: a pipe, a device, or what
/// was removed while it is open, behind a link of the kernel's (/proc/self/fd/1), which says none.
bool is_without_name(const fs::path& file, const fs::path& found) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  return !fs::is_regular_file(file, error) || !fs::equivalent(file, found, error);
}

std::optional<fs::file_time_type> time_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const fs::file_time_type time = fs::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

}  // namespace

void check_is_no_folder(const std::string& option, const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw InputError(option + ": " + file.string() + " is a folder; the name of a file is wanted");
}

FormerFiles::FormerFiles(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) files_.push_back({file, time_of(file)});
}

std::string FormerFiles::state() const {
  std::string text;
  for (const File& file : files_)
    if (const auto now = time_of(file.path))
      text += "; " + file.path.string() +
              (now == file.time ? " is left as it was" : " is new and whole");
  return text;
}

fs::path PendingFile::part_of(fs::path file) { return file += ".penumbra.part"; }

PendingFile::PendingFile(const fs::path& file) : file_(file), part_(file) {
  const fs::path found = behind_links(file);
  if (is_without_name(file, found)) return;
  file_ = found;
  part_ = part_of(found);
  std::error_code error;
  if (fs::is_symlink(part_, error)) fs::remove(part_, error);
  lock_.emplace(part_, file_);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!finished_ && lock_) fs::remove(part_, ignored);
}

void PendingFile::finish() {
  std::error_code error;
  if (part_ != file_) fs::rename(part_, file_, error);
  if (error) throw InputError(file_.string() + ": cannot be replaced: " + error.message());
  finished_ = true;
}

}  // namespace penumbra::io
