// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra::io {

/// Keeps other programs from writing to the same place as long as it lives, by an advisory lock
/// (flock). A file system without such locks is used as if nobody else wrote.
class FileLock {
 public:
  /// Locks a folder. Throws InputError if another program holds it.
  explicit FileLock(const std::filesystem::path& folder);

  /// Locks a file, which is made if it is not there. `name`: what messages call it.
  FileLock(const std::filesystem::path& file, const std::filesystem::path& name);

  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace penumbra::io
