// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

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

/// A regular file that is read from its start. Pipes and folders are refused, so that no read waits
/// for ever.
class InputFile {
 public:
  InputFile() = default;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  [[nodiscard]] FileResult open(const std::filesystem::path& file);

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Reads up to `count` bytes; fewer only at the end of the file or after a fault of the device.
  std::size_t read(void* to, std::size_t count);

  /// The same from any position. Does not move the position of read().
  std::size_t read_at(std::uint64_t offset, void* to, std::size_t count) const;

 private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A file that is written from its start. Every member throws InputError that names the file if the
/// system refuses.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& file);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  void write(const void* from, std::size_t count);
  void close();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Writes a file. Throws as OutputFile.
void write_file(const std::filesystem::path& file, const void* from, std::size_t count);

}  // namespace penumbra::io
