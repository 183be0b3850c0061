// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/robot/file_locator-inl.hpp>
#include <penumbra/robot/package_search-inl.hpp>

namespace penumbra::detail {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// %20 and the like, as URIs may have them.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    const bool escape = text[i] == '%' && i + 2 < text.size() &&
                        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    out += escape && value != 0 ? static_cast<char>(value) : text[i];
    if (escape && value != 0) i += 2;
  }
  return out;
}

fs::path existing(const fs::path& folder, std::string_view rest) {
  const fs::path as_written = folder / rest;
  return is_file(as_written) ? as_written : folder / decoded(rest);
}

struct Uri {
  std::string scheme;  // lower case; empty for a plain path
  std::string_view rest;
};

Uri split(std::string_view uri) {
  const std::size_t end = uri.find("://");
  if (end == std::string_view::npos) return {"", uri};
  std::string scheme(uri.substr(0, end));
  std::transform(scheme.begin(), scheme.end(), scheme.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return {std::move(scheme), uri.substr(end + 3)};
}

std::optional<fs::path> first_with(const char* variable, const std::string& below) {
  std::error_code error;
  for (const fs::path& prefix : folders_in(variable))
    if (fs::is_directory(prefix / below, error)) return prefix / below;
  return std::nullopt;
}

}  // namespace

fs::path FileLocator::locate(const std::string& uri) {
  const auto [scheme, rest] = split(uri);
  if (scheme == "package") return locate_in_package(uri, rest, false);
  if (scheme == "model") return locate_in_package(uri, rest, true);
  if (!scheme.empty() && scheme != "file")
    throw InputError(in_quotes(uri) + ": " + scheme +
                     ":// cannot be read; expected package://, model://, file:// or a path");
  const bool has_host = scheme == "file" && rest.starts_with("localhost/");
  fs::path file = existing(folder_, has_host ? rest.substr(9) : rest);
  if (!is_file(file)) throw InputError("no file at " + file.string());
  return file;
}

fs::path FileLocator::locate_in_package(const std::string& uri, std::string_view rest,
                                        bool is_model) {
  const std::size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string_view::npos || slash + 1 == rest.size())
    throw InputError(in_quotes(uri) + " is not of the form package://NAME/path/in/package");
  const std::string name(rest.substr(0, slash));
  const std::string_view inside = rest.substr(slash + 1);
  const fs::path folder = package_folder(name, inside, is_model);
  fs::path file = existing(folder, inside);
  if (!is_file(file))
    throw InputError("no file at " + file.string() + " (package " + in_quotes(name) + " is " +
                     folder.string() + ")");
  return file;
}

fs::path FileLocator::package_folder(const std::string& name, const fs::path& file, bool is_model) {
  if (const auto at = given_.find(name); at != given_.end()) {
    std::error_code error;
    if (fs::is_directory(at->second, error)) return at->second;
    throw InputError("package " + in_quotes(name) + " was given as " + at->second.string() +
                     ", which is no folder");
  }
  if (const auto at = found_.find(name); at != found_.end()) return at->second;

  const auto taken = search(name, file, is_model);
  if (!taken)
    throw InputError("package " + in_quotes(name) + " was not found by AMENT_PREFIX_PATH, by " +
                     "ROS_PACKAGE_PATH, or beside or above the URDF with " + file.string() +
                     " in it; give its folder: --package " + name + "=DIR");
  notes_.push_back("package " + name + ": taken from " + taken->folder.string() + " (" +
                   taken->how + ")");
  return found_[name] = taken->folder;
}

std::optional<FileLocator::Candidate> FileLocator::search(const std::string& name,
                                                          const fs::path& file, bool is_model) {
  if (is_model)
    for (const char* v : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH"})
      if (const auto folder = first_with(v, name))
        return Candidate{*folder, std::string("by ") + v};
  if (const auto folder = first_with("AMENT_PREFIX_PATH", "share/" + name))
    return Candidate{*folder, "by AMENT_PREFIX_PATH"};
  if (!ros_packages_) ros_packages_ = crawl_ros_packages();
  if (const auto at = ros_packages_->find(name); at != ros_packages_->end())
    return Candidate{at->second, "by ROS_PACKAGE_PATH"};
  for (const fs::path& near : folders_near(folder_, name))
    if (is_file(existing(near, file.string())))
      return Candidate{near, "found beside or above the URDF"};
  return std::nullopt;
}

}  // namespace penumbra::detail
