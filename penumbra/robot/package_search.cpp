// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <set>
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/package_search-inl.hpp>

namespace penumbra::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIgnoreMarks[] = {"CATKIN_IGNORE", "ROSPACK_IGNORE", "rospack_nosubdirs",
                                        "AMENT_IGNORE", "COLCON_IGNORE"};

bool is_ignored(const fs::path& folder) {
  std::error_code error;
  return std::any_of(std::begin(kIgnoreMarks), std::end(kIgnoreMarks),
                     [&](const char* mark) { return fs::exists(folder / mark, error); });
}

std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code unreadable;
    if (at->is_directory(unreadable) && !at->path().filename().string().starts_with('.'))
      out.push_back(at->path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Walks folders once each, whatever links lead to them.
class Crawler {
 public:
  void crawl(const fs::path& folder) {
    std::error_code error;
    const fs::path canonical = fs::canonical(folder, error);
    if (error || !visited_.insert(canonical).second || is_ignored(folder)) return;
    if (fs::exists(folder / "package.xml", error)) {
      if (const auto name = package_name(folder)) packages_.emplace(*name, folder);
      packages_.emplace(folder.filename().string(), folder);
      return;
    }
    for (const fs::path& sub : subfolders(folder)) crawl(sub);
  }

  std::map<std::string, fs::path> take() { return std::move(packages_); }

 private:
  std::set<fs::path> visited_;
  std::map<std::string, fs::path> packages_;
};

}  // namespace

std::vector<fs::path> folders_in(const char* variable) {
  std::vector<fs::path> out;
  const char* value = std::getenv(variable);
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) out.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

std::optional<std::string> package_name(const fs::path& folder) {
  const fs::path file = folder / "package.xml";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    const std::string text = read_whole_file(file, FileLimit::text);
    for (const XmlElement& child : read_xml(text, file.string()).children)
      if (child.name == "name" && !child.text.empty()) return child.text;
  } catch (const InputError&) {
    // Another package's broken file is not the user's concern here; its folder's name still counts.
  }
  return std::nullopt;
}

std::map<std::string, fs::path> crawl_ros_packages() {
  Crawler crawler;
  for (const fs::path& folder : folders_in("ROS_PACKAGE_PATH")) crawler.crawl(folder);
  return crawler.take();
}

std::vector<fs::path> folders_near(const fs::path& start, const std::string& name) {
  std::vector<fs::path> out;
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(start.empty() ? fs::path(".") : start, error);
  for (fs::path at = error ? start : absolute; !at.empty(); at = at.parent_path()) {
    if (at.filename() == name || package_name(at) == name) out.push_back(at);
    if (fs::is_directory(at / name, error)) out.push_back(at / name);
    if (at == at.parent_path()) break;
  }
  return out;
}

}  // namespace penumbra::detail
