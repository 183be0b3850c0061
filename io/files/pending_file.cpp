// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/files/pending_file.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // as in Linux

/// Returns whether the open file still has its name: the program that held the lock may have
/// renamed it.
bool has_name(int descriptor, const fs::path& name) {
  struct stat opened = {}, named = {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Returns the descriptor that holds the lock.
int locked(const fs::path& path, int flags, const fs::path& name) {
  for (;;) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0)
      throw InputError(name.string() +
                       ": cannot be written: " + std::generic_category().message(errno));
    const bool is_taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_taken && has_name(descriptor, path)) return descriptor;
    ::close(descriptor);
    if (is_taken)
      throw InputError(name.string() +
                       ": another program is writing it; wait for its end, or choose another name");
  }
}

/// Returns the end of a chain of links, which need not exist.
fs::path behind_links(fs::path file) {
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(file, error); ++i)
    file = file.parent_path() / fs::read_symlink(file, error);
  return file;
}

/// Returns whether `file` exists and is not the regular file `found`: a pipe, a device, or a
/// removed file that is open (/proc/self/fd/1).
bool is_without_name(const fs::path& file, const fs::path& found) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  return !fs::is_regular_file(file, error) || !fs::equivalent(file, found, error);
}

}  // namespace

void check_is_no_folder(const std::string& option, const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw InputError(option + ": " + file.string() + " is a folder; expected the name of a file");
}

FileLock::FileLock(const fs::path& folder)
    : descriptor_(locked(folder / ".", O_RDONLY | O_DIRECTORY, folder)) {}

FileLock::FileLock(const fs::path& file, const fs::path& name)
    : descriptor_(locked(file, O_RDWR | O_CREAT, name)) {}

FileLock::~FileLock() { ::close(descriptor_); }

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
