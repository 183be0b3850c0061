// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

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

/// Throws InputError if `file`, which `option` names, is a folder.
void check_is_no_folder(const std::string& option, const std::filesystem::path& file);

/// A file that is written completely or not at all. The content goes to FILE.penumbra.part, which
/// finish() renames to FILE. A link stays, and its target is replaced. A pipe or device
/// (/dev/stdout) is written directly.
class PendingFile {
 public:
  /// Makes the part, or takes over the part of a program that was killed. Throws InputError if it
  /// cannot be made, or another program is writing it.
  explicit PendingFile(const std::filesystem::path& file);
  /// Removes the part unless it was finished. It must be closed.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// The file to write.
  [[nodiscard]] const std::filesystem::path& part() const { return part_; }

  /// Returns the name of a file's part.
  [[nodiscard]] static std::filesystem::path part_of(std::filesystem::path file);

  /// Renames the part, which is written and closed. Throws InputError if this fails.
  void finish();

 private:
  std::filesystem::path file_;
  std::filesystem::path part_;
  std::optional<FileLock> lock_;
  bool finished_ = false;
};

}  // namespace penumbra::io
