// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace penumbra::io {

/// Throws InputError where `file`, which `option` names, is a folder. Nothing is touched.
void check_is_no_folder(const std::string& option, const std::filesystem::path& file);

/// For the end of an error's message: that a file is still what it was before; empty where there is
/// no such regular file.
[[nodiscard]] std::string left_as_it_was(const std::filesystem::path& file);

/// A file that is written whole or not at all: under another name beside it, FILE.penumbra.part,
/// which takes its place in finish(). Behind a link it is what the link leads to that is replaced.
/// What is there and no regular file (/dev/stdout on a pipe), or has no name any more, is written
/// to as it is. What has a file open that is replaced (as its stdout) goes on with the old one.
class PendingFile {
 public:
  /// Removes the part of an earlier program that was killed; creates nothing.
  explicit PendingFile(const std::filesystem::path& file);
  /// Removes the part, unless it was finished. Whoever writes must have closed it.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// What is to be written.
  [[nodiscard]] const std::filesystem::path& part() const { return part_; }

  /// To be called once the part is written and closed. Throws InputError where it cannot take the
  /// file's place.
  void finish();

 private:
  std::filesystem::path file_;
  std::filesystem::path part_;
  bool finished_ = false;
};

}  // namespace penumbra::io
