// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/files/file_lock.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

FileLock::FileLock(const fs::path& folder)
    : descriptor_(locked(folder / ".", O_RDONLY | O_DIRECTORY, folder)) {}

FileLock::FileLock(const fs::path& file, const fs::path& name)
    : descriptor_(locked(file, O_RDWR | O_CREAT, name)) {}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace penumbra::io
