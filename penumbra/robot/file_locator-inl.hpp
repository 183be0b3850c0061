// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::detail {

/// Finds the files that a URDF names: package://NAME/..., model://NAME/..., file://..., and paths
/// relative to the URDF's folder.
class FileLocator {
 public:
  FileLocator(std::filesystem::path folder, std::map<std::string, std::filesystem::path> packages)
      : folder_(std::move(folder)), given_(std::move(packages)) {}

  /// The file's path, which exists. Throws InputError that names the URI, where it was looked for
  /// and what would help.
  [[nodiscard]] std::filesystem::path locate(const std::string& uri);

  /// One line for each package that was found without being given.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Candidate {
    std::filesystem::path folder;
    std::string how;
  };

  std::filesystem::path locate_in_package(const std::string& uri, std::string_view rest,
                                          bool is_model);
  std::filesystem::path package_folder(const std::string& name, const std::filesystem::path& file,
                                       bool is_model);
  std::optional<Candidate> search(const std::string& name, const std::filesystem::path& file,
                                  bool is_model);

  std::filesystem::path folder_;
  std::map<std::string, std::filesystem::path> given_;
  std::map<std::string, std::filesystem::path> found_;
  std::optional<std::map<std::string, std::filesystem::path>> ros_packages_;  // crawled once
  std::vector<std::string> notes_;
};

}  // namespace penumbra::detail
