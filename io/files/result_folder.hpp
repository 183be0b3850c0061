// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <io/files/pending_file.hpp>

namespace penumbra::io {

/// A file that a command writes into its output folder.
struct ResultFile {
  std::string name;        ///< may be a pattern of fnmatch(3): "extra_*.stl"
  std::string start = {};  ///< what all files of the command begin with; empty: anything
  bool is_wanted = true;   ///< false: only removed, if an earlier command wrote it
};

struct ResultFolderOptions {
  std::filesystem::path path;
  ResultFile report;                         ///< shows whose results these are; written last
  std::vector<ResultFile> others = {};       ///< next to it
  std::vector<std::string> subfolders = {};  ///< with results of their own
  bool force = false;                        ///< also a folder with other files
  std::string advice = "choose another folder with -o";
};

/// What indented JSON and the pages of results begin with.
inline constexpr const char* json_begin = "{\n  \"penumbra\": ";
inline constexpr const char* page_begin = "<!doctype html>\n<!-- penumbra";

/// The output folder of a command, which no other program uses as long as this exists. The files of
/// add() appear together at the end, whole, and are not written through links.
class ResultFolder {
 public:
  /// Makes the folder. Throws InputError if it cannot be made or another program writes into it,
  /// and, unless forced, if it holds files but no earlier report, or a file of another with the
  /// name of a result.
  explicit ResultFolder(ResultFolderOptions options);
  /// Removes unfinished results, and the folder if it is empty and was made by this.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return options_.path; }

  /// Returns whether an earlier command wrote here. A killed one leaves the report's part.
  [[nodiscard]] bool has_former() const;

  /// Removes earlier results, the report last, but no file of the input's. Call it when all inputs
  /// are open: whatever fails later leaves nothing that looks like its result.
  void remove_former(std::span<const std::filesystem::path> inputs = {}) const;

  /// Calls `write` with the path of a new file, which finish() renames.
  template <typename Write>
  void add(const std::string& name, const Write& write) {
    const auto place = name == options_.report.name ? parts_.end() : parts_.begin();
    write((*parts_.insert(place, std::make_unique<PendingFile>(path() / name)))->part());
  }
  void add_text(const std::string& name, std::string_view text);

  /// Gives the files their names, the report last.
  void finish();

 private:
  [[nodiscard]] bool holds_other_files() const;
  void check_is_ours(const ResultFile& result) const;
  [[nodiscard]] std::vector<std::filesystem::path> files_of(const ResultFile& result) const;

  ResultFolderOptions options_;
  bool is_made_;  // by this
  FileLock lock_;
  std::vector<std::unique_ptr<PendingFile>> parts_;  // the report's last
};

}  // namespace penumbra::io
