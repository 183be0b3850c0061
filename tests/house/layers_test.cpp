// SPDX-License-Identifier: Apache-2.0
// The house has floors: each part of the code uses only those below it.
#include "source_tree.hpp"

#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using Names = std::set<std::string>;

Names words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Which folders of penumbra/ a folder may include.
const std::map<std::string, Names>& allowed_rooms() {
  static const std::string poses = "base mesh robot time camera render labels poses";
  static const std::string targets = poses + " tracking cloud targets";
  static const std::string frame = targets + " pipeline";
  static const Names setup = words(frame + " tuning calibration diagnosis");
  static const Names core = words(frame + " tuning calibration diagnosis session planning fusion");
  static const std::map<std::string, Names> rooms{
      {"penumbra/base", words("base")},
      {"penumbra/mesh", words("base mesh")},
      {"penumbra/robot", words("base mesh robot")},
      {"penumbra/time", words("base mesh robot time")},
      {"penumbra/camera", words("base camera")},
      {"penumbra/render", words("base camera mesh render")},
      {"penumbra/labels", words("base camera labels")},
      {"penumbra/poses", words(poses)},
      {"penumbra/tracking", words("base labels tracking")},
      {"penumbra/targets", words(targets)},
      {"penumbra/pipeline", words(frame)},
      {"penumbra/cloud", words(poses + " cloud")},
      {"penumbra/tuning", setup},
      {"penumbra/calibration", setup},
      {"penumbra/diagnosis", setup},
      {"penumbra/session", core},
      {"penumbra/planning",
       words("base robot time camera render labels poses targets pipeline planning")},
      {"penumbra/fusion", words("base camera labels pipeline fusion")},
      {"io", core},
      {"sim", core},
      {"apps", core},
      {"python", core},
      {"research", core}};
  return rooms;
}

/// Which top folders may include headers of another one.
const std::map<std::string, Names> users_of_tops{
    {"io", {"io", "sim", "apps", "python", "research"}},
    {"sim", {"sim", "apps", "research"}},
    {"apps", {"apps", "research"}},
    {"python", {"python"}},
    {"research", {"research"}}};

/// How many shipped files may include a library, and in which folder they stand.
struct Library {
  std::string include;  // what the include starts with
  std::string folder;
  std::size_t files;
  Names users = {};
};

std::vector<Library> libraries() {
  // By folder: what includes start with, and the number of files.
  static const std::vector<std::pair<std::string, std::string>> folders{
      {"penumbra/base", "tinyxml2 1 hwy/ 2"},
      {"penumbra/mesh", "nlohmann/ 1 meshoptimizer.h 2"},
      {"penumbra/render", "meshoptimizer.h 1 hwy/ 2"},
      {"penumbra/labels", "hwy/ 6"},
      {"penumbra/render/gl", "epoxy/egl.h 1 dlfcn.h 1 epoxy/gl.h 7"},
      {"penumbra/robot", "fnmatch.h 1"},
      {"io/files",
       "fnmatch.h 1 spawn.h 1 yaml-cpp/ 2 png.h 1 jpeglib.h 1 jerror.h 1 tiffio.h 1 OpenEXR/ 1 "
       "libdeflate.h 1"},
      {"apps", "malloc.h 1 CLI/ 2"},
      {"io", "nlohmann/ 2"},
      {"io/mcap", "lz4frame.h 1 zstd 1 zlib.h 1"},
      {"io/bag", "sqlite3.h 1"},
      {"io/web", "boost/ 2"},
      {"io/dds", "dds/ 8 nettle/ 1"},
      {"sim", "mujoco/ 1 epoxy/egl.h 1"},
      {"python", "pybind11/ 6"},
      {"research", "CLI/ 1 nlohmann/ 1 opencv2/ 1"}};
  std::vector<Library> all;
  for (const auto& [folder, text] : folders) {
    std::istringstream in(text);
    Library library{.include = "", .folder = folder, .files = 0};
    while (in >> library.include >> library.files) all.push_back(library);
  }
  return all;
}

std::string room_of(const std::string& path) {
  const auto first = path.find('/');
  const std::string top = path.substr(0, first);
  return top == "penumbra" ? path.substr(0, path.find('/', first + 1)) : top;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool is_standard(const std::string& include) {
  static const std::regex pattern("[a-z_]+");
  return std::regex_match(include, pattern);
}

std::vector<SourceFile> shipped() {
  return source_files({"penumbra", "io", "sim", "apps", "python", "research"}, {".cpp", ".hpp"});
}

TEST(Layers, IncludesPointDown) {
  const auto files = shipped();
  ASSERT_GT(files.size(), 10U);
  for (const auto& file : files) {
    const auto rule = allowed_rooms().find(room_of(file.path));
    ASSERT_NE(rule, allowed_rooms().end()) << file.path << " stands in a folder without a rule";
    for (const auto& include : includes(file)) {
      if (include.starts_with("penumbra/")) {
        const std::string room = room_of(include).substr(std::string("penumbra/").size());
        EXPECT_TRUE(rule->second.contains(room)) << file.path << " includes " << include;
      }
      const auto users = users_of_tops.find(include.substr(0, include.find('/')));
      if (users == users_of_tops.end()) continue;
      const std::string top = file.path.substr(0, file.path.find('/'));
      EXPECT_TRUE(users->second.contains(top)) << file.path << " includes " << include;
    }
  }
}

TEST(Layers, PrivateHeadersServeTheirFolderAlone) {
  for (const auto& file : shipped()) {
    for (const auto& include : includes(file)) {
      if (!include.ends_with("-inl.hpp") || include.starts_with("penumbra/base/")) continue;
      EXPECT_TRUE(folder_of(file.path).starts_with(folder_of(include)))
          << file.path << " includes " << include;
    }
  }
}

TEST(Layers, LibrariesStayInFewFilesOfTheirFolders) {
  const std::filesystem::path root = PENUMBRA_SOURCE_DIR;
  std::vector<Library> all = libraries();
  for (const auto& file : shipped()) {
    for (const auto& include : includes(file)) {
      const std::string top = include.substr(0, include.find('/'));
      const bool ours = top == "penumbra" || users_of_tops.contains(top) ||
                        std::filesystem::exists((root / file.path).parent_path() / include);
      const bool system = is_standard(include) || include.starts_with("Eigen/") ||
                          include.starts_with("sys/") || include == "unistd.h" ||
                          include == "fcntl.h";
      bool at_home = false;
      for (Library& library : all) {
        if (!include.starts_with(library.include) || !file.path.starts_with(library.folder + "/"))
          continue;
        at_home = true;
        library.users.insert(file.path);
      }
      EXPECT_TRUE(ours || system || at_home) << file.path << " includes " << include;
    }
  }
  for (const Library& library : all)
    EXPECT_LE(library.users.size(), library.files)
        << library.include << " is included by " << testing::PrintToString(library.users);
}

TEST(Layers, InstalledHeadersNeedOnlyTheStandardLibraryAndEigen) {
  for (const auto& file : source_files({"penumbra"}, {".hpp"})) {
    if (file.ends_with("-inl.hpp")) continue;
    for (const auto& include : includes(file)) {
      const bool ours = include.starts_with("penumbra/") && !include.ends_with("-inl.hpp");
      EXPECT_TRUE(ours || is_standard(include) || include.starts_with("Eigen/"))
          << file.path << " includes " << include;
    }
  }
}

}  // namespace
}  // namespace penumbra::test
