// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <io/files/frame_pattern.hpp>
#include <io/files/pending_file.hpp>

namespace penumbra::io {

/// A file that a command writes into its output folder.
struct ResultFile {
  std::string name;        ///< may be a pattern of fnmatch(3): "extra_*.stl"
  std::string start = {};  ///< what all files of the command begin with; empty: anything
  bool is_wanted = true;   ///< false: only removed, if an earlier command wrote it
};

/// The files of frames in a folder of their own, which is in the output folder.
struct FrameFiles {
  FramePattern pattern;
  bool is_wanted = true;  ///< likewise
};

struct ResultFolderOptions {
  std::filesystem::path path;
  ResultFile report;                    ///< shows whose results these are; written last
  std::vector<ResultFile> others = {};  ///< next to it
  std::vector<FrameFiles> frames = {};
  std::vector<std::string> subfolders = {};  ///< with results of their own
  bool force = false;                        ///< also a folder with other files
  std::string advice = "choose another folder with -o";
};

/// What indented JSON and the pages of results begin with.
inline constexpr const char* json_begin = "{\n  \"penumbra\": ";
inline constexpr const char* page_begin = "<!doctype html>\n<!-- penumbra";

/// The output folder of a command, which no other program uses as long as this exists. The files of
/// add() appear together at the end, whole. Nothing is written or removed through a link in it.
///
/// From begin() to finish() the folder holds the report's part. A killed command leaves it: it says
/// that files with the names of results are its own, and the next command replaces them.
class ResultFolder {
 public:
  /// Makes the folder. Throws InputError if it cannot be made or another program writes into it,
  /// if one of its own folders is a link, and, unless forced, if it holds files but no earlier
  /// report, or a file of another with the name of a result.
  explicit ResultFolder(ResultFolderOptions options);
  /// Removes all results unless they are finished, and the folder if it is empty and was made by
  /// this.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return options_.path; }

  /// Removes earlier results, the report first, but no file of the input's; makes the folders of
  /// frames. Call it when all inputs are open: whatever fails later leaves nothing that looks like
  /// its result.
  void begin(std::span<const std::filesystem::path> inputs = {});

  // After begin():

  /// Calls `write` with the path of a new file, which finish() renames.
  template <typename Write>
  void add(const std::string& name, const Write& write) {
    if (name != options_.report.name)
      parts_.insert(parts_.begin(), std::make_unique<PendingFile>(path() / name));
    write((name == options_.report.name ? parts_.back() : parts_.front())->part());
  }
  void add_text(const std::string& name, std::string_view text);

  /// Returns the file of a frame for writing. What had its name is removed. `kind`: the index of
  /// its FrameFiles.
  [[nodiscard]] std::filesystem::path frame_file(std::size_t kind, std::int64_t index);

  /// Gives the files their names, the report last. add() was called for the report.
  void finish();

 private:
  [[nodiscard]] bool finds_former() const;
  void refuse_links() const;
  void leave_part() const;
  [[nodiscard]] bool holds_other_files() const;
  void check_is_ours(const ResultFile& result) const;
  [[nodiscard]] std::vector<std::filesystem::path> files_of(const ResultFile& result) const;
  void remove(const std::filesystem::path& file) const;
  void remove_former_frames() const;

  ResultFolderOptions options_;
  bool is_made_;  // by this
  FileLock lock_;
  bool has_former_;                                  // of an earlier command, which may be killed
  std::vector<std::unique_ptr<PendingFile>> parts_;  // the report's last
  std::vector<std::pair<std::size_t, std::int64_t>> frames_;  // kind and index, unfinished
};

}  // namespace penumbra::io
