// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/file_lock.hpp>

namespace penumbra::io {

/// Throws InputError where `file`, which `option` names, is a folder. Nothing is touched.
void check_is_no_folder(const std::string& option, const std::filesystem::path& file);

/// Remembers files that a command may replace, to say in its error what became of them.
class FormerFiles {
 public:
  explicit FormerFiles(const std::vector<std::filesystem::path>& files);

  /// Returns "; FILE is left as it was" or "; FILE is new and whole" for each regular file.
  [[nodiscard]] std::string state() const;

 private:
  struct File {
    std::filesystem::path path;
    std::optional<std::filesystem::file_time_type> time;  // of its last change, if it was there
  };
  std::vector<File> files_;
};

/// Runs a command. To the message of what it throws FormerFiles::state() is added.
template <typename Run>
int run_or_say_state(const std::vector<std::filesystem::path>& files, const Run& run) {
  const FormerFiles former(files);
  try {
    return run();
  } catch (const InputError& error) {
    throw InputError(error.what() + former.state());
  } catch (const DeviceError& error) {
    throw DeviceError(error.what() + former.state());
  }
}

/// A file that is written whole or not at all: under another name beside it, FILE.penumbra.part,
/// which takes its place in finish(). Behind a link it is what the link leads to that is replaced.
/// What is there and no regular file (/dev/stdout on a pipe), or has no name any more, is written
/// to as it is. What has a file open that is replaced (as its stdout) goes on with the old one.
class PendingFile {
 public:
  /// Makes the part, or takes over that of a program that was killed. Throws InputError if it
  /// cannot be made, or another program is writing it.
  explicit PendingFile(const std::filesystem::path& file);
  /// Removes the part, unless it was finished. Whoever writes must have closed it.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// What is to be written.
  [[nodiscard]] const std::filesystem::path& part() const { return part_; }

  /// Returns the part's name of a file that is no link.
  [[nodiscard]] static std::filesystem::path part_of(std::filesystem::path file);

  /// To be called once the part is written and closed. Throws InputError where it cannot take the
  /// file's place.
  void finish();

 private:
  std::filesystem::path file_;
  std::filesystem::path part_;
  std::optional<FileLock> lock_;
  bool finished_ = false;
};

}  // namespace penumbra::io
