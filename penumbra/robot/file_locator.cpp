// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/file_locator.hpp>

namespace penumbra::detail {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// Replaces %20 and the like, as URIs may have them.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    out += is_escape && value != 0 ? static_cast<char>(value) : text[i];
    if (is_escape && value != 0) i += 2;
  }
  return out;
}

fs::path existing(const fs::path& folder, std::string_view rest) {
  const fs::path as_written = folder / rest;
  return is_file(as_written) ? as_written : folder / decoded(rest);
}

/// Whether a package's folder has the file; without a name, whether it is a folder.
bool has_file(const fs::path& folder, const fs::path& file) {
  return file.empty() ? is_folder(folder) : is_file(existing(folder, file.string()));
}

/// Returns the folders in an environment variable, which are separated by ':'.
std::vector<fs::path> folders_in(const char* variable) {
  std::vector<fs::path> folders;
  const char* value = std::getenv(variable);
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return folders;
}

/// Whether the folder's package.xml has that name.
bool is_package(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / "package.xml";
  if (!is_file(file)) return false;
  try {
    const std::string text = read_whole_file(file, FileLimit::text);
    for (const XmlElement& child : read_xml(text, file.string()).children)
      if (child.name == "name") return child.text == name;
  } catch (const InputError&) {  // another package's broken file
  }
  return false;
}

/// Returns the folder without symbolic links, or as it is.
fs::path canonical_of(const fs::path& folder) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  return error ? folder : canonical;
}

/// Returns the folders that may be package `name`, the nearest first: NAME in the URDF's folder and
/// in each folder above it, and those folders themselves if they are called NAME or have its
/// package.xml.
std::vector<fs::path> folders_near(const fs::path& start, const std::string& name) {
  std::vector<fs::path> folders;
  for (fs::path at = canonical_of(start); !at.empty(); at = at.parent_path()) {
    if (at.filename() == name || is_package(at, name)) folders.push_back(at);
    if (is_folder(at / name)) folders.push_back(at / name);
    if (at == at.parent_path()) break;
  }
  return folders;
}

/// Returns the folders meshes/NAME and meshes/MODEL/NAME in the URDF's folder and in the one above.
std::vector<fs::path> folders_in_meshes(const fs::path& start, const std::string& name) {
  std::vector<fs::path> folders;
  const fs::path folder = canonical_of(start);
  for (const fs::path& meshes : {folder / "meshes", folder.parent_path() / "meshes"}) {
    if (is_folder(meshes / name)) folders.push_back(meshes / name);
    std::error_code error;
    for (fs::directory_iterator at(meshes, error), end; !error && at != end; at.increment(error))
      if (is_folder(at->path() / name)) folders.push_back(at->path() / name);
  }
  return folders;
}

}  // namespace

fs::path FileLocator::locate(const std::string& uri) {
  const std::size_t end = uri.find("://");
  std::string scheme = uri.substr(0, end == std::string::npos ? 0 : end);
  std::transform(scheme.begin(), scheme.end(), scheme.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string_view rest = uri;
  if (end != std::string::npos) rest.remove_prefix(end + 3);
  if (scheme == "package" || scheme == "model") return locate_in_package(uri, rest);
  if (!scheme.empty() && scheme != "file")
    throw InputError(in_quotes(uri) + ": " + scheme +
                     ":// cannot be read; expected package://, model://, file:// or a path");
  if (scheme == "file" && rest.starts_with("localhost/")) rest.remove_prefix(9);
  fs::path file = existing(folder_, rest);
  if (!is_file(file)) throw InputError("no file at " + file.string());
  return file;
}

fs::path FileLocator::locate_in_package(const std::string& uri, std::string_view rest) {
  const std::size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string_view::npos || slash + 1 == rest.size())
    throw InputError(in_quotes(uri) + " is not of the form package://NAME/path/in/package");
  const std::string name(rest.substr(0, slash));
  const std::string_view inside = rest.substr(slash + 1);
  const fs::path folder = package_folder(name, inside);
  fs::path file = existing(folder, inside);
  if (!is_file(file))
    throw InputError("no file at " + file.string() + " (package " + in_quotes(name) + " is " +
                     folder.string() + ")");
  return file;
}

fs::path FileLocator::package_folder(const std::string& name, const fs::path& file) {
  if (const auto known = packages_.find(name); known != packages_.end()) {
    if (is_folder(known->second)) return known->second;
    throw InputError("package " + in_quotes(name) + " is taken from " + known->second.string() +
                     ", which is no folder");
  }
  const auto [folder, how] = search(name, file);
  if (folder.empty())
    throw InputError("package " + in_quotes(name) + " was not found by AMENT_PREFIX_PATH, by " +
                     "ROS_PACKAGE_PATH, or next to or above the URDF" +
                     (file.empty() ? "" : " with " + file.string() + " in it") +
                     "; give its folder: --package " + name + "=DIR");
  std::string note = "package " + name + ": taken from " + folder.string() + " (" + how + ")";
  if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
  if (!file.empty()) packages_[name] = folder;  // a folder alone may not be the one with the files
  return folder;
}

std::pair<fs::path, std::string> FileLocator::search(const std::string& name,
                                                     const fs::path& file) const {
  const std::pair<const char*, std::string> variables[] = {{"AMENT_PREFIX_PATH", "share/" + name},
                                                           {"ROS_PACKAGE_PATH", name},
                                                           {"GAZEBO_MODEL_PATH", name},
                                                           {"GZ_SIM_RESOURCE_PATH", name},
                                                           {"IGN_GAZEBO_RESOURCE_PATH", name}};
  for (const auto& [variable, below] : variables)
    for (const fs::path& prefix : folders_in(variable))
      if (has_file(prefix / below, file)) return {prefix / below, std::string("by ") + variable};
  for (const fs::path& near : folders_near(folder_, name))
    if (has_file(near, file)) return {near, "found next to or above the URDF"};
  // Folders of several models have files of the same names.
  const std::vector<fs::path> in_meshes = folders_in_meshes(folder_, name);
  if (in_meshes.size() == 1 && has_file(in_meshes.front(), file))
    return {in_meshes.front(), "no package has this name; found in the URDF's own"};
  return {};
}

}  // namespace penumbra::detail
