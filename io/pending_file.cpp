// SPDX-License-Identifier: Apache-2.0
#include <system_error>

#include <penumbra/base/error.hpp>

#include <io/pending_file.hpp>

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

/// Whether `file` is a file or a link of its own, not a folder or a device.
bool is_removable(const fs::path& file) {
  std::error_code error;
  const fs::file_status found = fs::symlink_status(file, error);
  return fs::is_regular_file(found) || fs::is_symlink(found);
}

}  // namespace

void check_is_no_folder(const std::string& option, const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw InputError(option + ": " + file.string() + " is a folder; the name of a file is wanted");
}

std::string left_as_it_was(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) ? "; " + file.string() + " is left as it was"
                                          : std::string();
}

PendingFile::PendingFile(const fs::path& file) : file_(file), part_(file) {
  const fs::path found = behind_links(file);
  if (is_without_name(file, found)) return;
  file_ = part_ = found;
  part_ += ".penumbra.part";
  std::error_code error;
  if (is_removable(part_)) fs::remove(part_, error);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!finished_ && part_ != file_ && is_removable(part_)) fs::remove(part_, ignored);
}

void PendingFile::finish() {
  std::error_code error;
  if (part_ != file_) fs::rename(part_, file_, error);
  if (error) throw InputError(file_.string() + ": cannot be replaced: " + error.message());
  finished_ = true;
}

}  // namespace penumbra::io
