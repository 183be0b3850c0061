// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>

namespace penumbra::io {

enum class FileStatus { ok, missing, bad };

/// The outcome of reading a file. Readers of stream data return it and never throw for the file's
/// content.
struct FileResult {
  FileStatus status = FileStatus::ok;
  std::string message;  ///< one line that names the file; empty if ok

  [[nodiscard]] bool ok() const { return status == FileStatus::ok; }

  /// Throws InputError with the message unless ok.
  void require() const {
    if (!ok()) throw InputError(message);
  }

  [[nodiscard]] static FileResult bad(const std::filesystem::path& file, const std::string& what) {
    return {FileStatus::bad, file.string() + ": " + what};
  }
};

}  // namespace penumbra::io
