// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace penumbra::test {

/// A text file of the source tree.
struct SourceFile {
  std::string path;  ///< relative to the repository's root, with '/'
  std::vector<std::string> lines;

  [[nodiscard]] bool ends_with(std::string_view ending) const {
    return std::string_view(path).ends_with(ending);
  }
  [[nodiscard]] bool is_cpp() const { return ends_with(".cpp") || ends_with(".hpp"); }
};

inline SourceFile read_source(const std::filesystem::path& root,
                              const std::filesystem::path& file) {
  SourceFile source{std::filesystem::relative(file, root).generic_string(), {}};
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) source.lines.push_back(line);
  return source;
}

/// Files under the folders (those that exist) whose names end in one of the endings, by path.
inline std::vector<SourceFile> source_files(const std::vector<std::string>& folders,
                                            const std::vector<std::string>& endings) {
  const std::filesystem::path root = PENUMBRA_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const auto& folder : folders) {
    if (!std::filesystem::is_directory(root / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string name = entry.path().filename().string();
      const bool wanted = std::any_of(endings.begin(), endings.end(),
                                      [&](const auto& ending) { return name.ends_with(ending); });
      if (entry.is_regular_file() && wanted) files.push_back(read_source(root, entry.path()));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

/// What a file includes, without brackets or quotes.
inline std::vector<std::string> includes(const SourceFile& file) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::vector<std::string> found;
  for (const auto& line : file.lines) {
    if (line.find("include") == std::string::npos) continue;  // the pattern is slow
    std::smatch match;
    if (std::regex_search(line, match, pattern)) found.push_back(match[1]);
  }
  return found;
}

}  // namespace penumbra::test
