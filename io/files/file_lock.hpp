// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra::io {

/// Keeps other programs from writing to the same place, by an advisory lock (flock). File systems
/// without such locks are used without.
class FileLock {
 public:
  /// Locks a folder. Throws InputError if another program holds it.
  explicit FileLock(const std::filesystem::path& folder);

  /// Locks a file, and makes it if it does not exist. `name`: its name in messages.
  FileLock(const std::filesystem::path& file, const std::filesystem::path& name);

  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace penumbra::io
