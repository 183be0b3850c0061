// SPDX-License-Identifier: Apache-2.0
// The house has floors: each part of the code uses only those below it.
#include "source_tree.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using Names = std::set<std::string>;

const std::map<std::string, Names>& allowed_rooms() {
  static const Names frame{"base",   "mesh",  "robot",    "time",    "camera",  "render",
                           "labels", "poses", "tracking", "targets", "pipeline"};
  const auto frame_and = [](std::initializer_list<const char*> more) {
    Names names = frame;
    names.insert(more.begin(), more.end());
    return names;
  };
  static const Names setup = frame_and({"tuning", "calibration", "diagnosis"});
  static const Names core =
      frame_and({"tuning", "calibration", "diagnosis", "session", "scene", "cloud"});
  static const std::map<std::string, Names> rooms{
      {"penumbra/base", {"base"}},
      {"penumbra/mesh", {"base", "mesh"}},
      {"penumbra/robot", {"base", "mesh", "robot"}},
      {"penumbra/time", {"base", "mesh", "robot", "time"}},
      {"penumbra/camera", {"base", "camera"}},
      {"penumbra/render", {"base", "camera", "mesh", "render"}},
      {"penumbra/labels", {"base", "camera", "labels"}},
      {"penumbra/poses", {"base", "mesh", "robot", "time", "camera", "render", "labels", "poses"}},
      {"penumbra/tracking", {"base", "labels", "tracking"}},
      {"penumbra/targets",
       {"base", "mesh", "robot", "time", "camera", "render", "labels", "poses", "tracking",
        "targets"}},
      {"penumbra/pipeline", frame},
      {"penumbra/tuning", setup},
      {"penumbra/calibration", setup},
      {"penumbra/diagnosis", setup},
      {"penumbra/session", core},
      {"penumbra/scene", frame_and({"scene"})},
      {"penumbra/cloud",
       {"base", "mesh", "robot", "time", "camera", "render", "labels", "poses", "tracking",
        "targets", "cloud"}},
      {"io", core},
      {"sim", core},
      {"apps", core},
      {"python", core},
      {"research", core}};
  return rooms;
}

/// Which top folders may include headers of another one.
const std::map<std::string, Names>& users_of_tops() {
  static const std::map<std::string, Names> tops{
      {"io", {"io", "sim", "apps", "python", "research"}},
      {"sim", {"sim", "apps", "research"}},
      {"apps", {"apps", "research"}},
      {"python", {"python"}},
      {"research", {"research"}}};
  return tops;
}

/// How many shipped files may include a library, and in which folder they stand.
struct Library {
  std::string include;  // what the include starts with
  std::string folder;
  std::size_t files;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> all{{"tinyxml2", "penumbra/base", 1},
                                        {"nlohmann/", "penumbra/mesh", 1},
                                        {"meshoptimizer.h", "penumbra/mesh", 2},
                                        {"meshoptimizer.h", "penumbra/render", 1},
                                        {"hwy/", "penumbra/base", 2},
                                        {"hwy/", "penumbra/labels", 5},
                                        {"hwy/", "penumbra/render", 2},
                                        {"epoxy/egl.h", "penumbra/render/gl", 1},
                                        {"dlfcn.h", "penumbra/render/gl", 1},
                                        {"fnmatch.h", "penumbra/robot", 1},
                                        {"fnmatch.h", "io/files", 1},
                                        {"malloc.h", "apps", 1},
                                        {"spawn.h", "io/files", 1},
                                        {"epoxy/gl.h", "penumbra/render/gl", 7},
                                        {"yaml-cpp/", "io/files", 2},
                                        {"png.h", "io/files", 1},
                                        {"jpeglib.h", "io/files", 1},
                                        {"jerror.h", "io/files", 1},
                                        {"tiffio.h", "io/files", 1},
                                        {"OpenEXR/", "io/files", 1},
                                        {"nlohmann/", "io", 2},
                                        {"libdeflate.h", "io/files", 1},
                                        {"lz4frame.h", "io/mcap", 1},
                                        {"zstd", "io/mcap", 1},
                                        {"zlib.h", "io/mcap", 1},
                                        {"sqlite3.h", "io/bag", 1},
                                        {"boost/", "io/web", 2},
                                        {"dds/", "io/dds", 8},
                                        {"nettle/", "io/dds", 1},
                                        {"mujoco/", "sim", 1},
                                        {"epoxy/egl.h", "sim", 1},
                                        {"CLI/", "apps", 2},
                                        {"pybind11/", "python", 6},
                                        {"CLI/", "research", 1},
                                        {"nlohmann/", "research", 1},
                                        {"opencv2/", "research", 1}};
  return all;
}

std::string room_of(const std::string& path) {
  const auto first = path.find('/');
  const std::string top = path.substr(0, first);
  return top == "penumbra" ? path.substr(0, path.find('/', first + 1)) : top;
}

bool is_standard(const std::string& include) {
  static const std::regex pattern("[a-z_]+");
  return std::regex_match(include, pattern);
}

bool stands_beside(const SourceFile& file, const std::string& include) {
  const std::filesystem::path root = PENUMBRA_SOURCE_DIR;
  return std::filesystem::exists((root / file.path).parent_path() / include);
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
      const auto users = users_of_tops().find(include.substr(0, include.find('/')));
      if (users == users_of_tops().end()) continue;
      const std::string top = file.path.substr(0, file.path.find('/'));
      EXPECT_TRUE(users->second.contains(top)) << file.path << " includes " << include;
    }
  }
}

TEST(Layers, LibrariesStayInFewFiles) {
  for (const auto& library : libraries()) {
    Names users;
    for (const auto& file : shipped())
      for (const auto& include : includes(file))
        if (include.starts_with(library.include) && file.path.starts_with(library.folder + "/"))
          users.insert(file.path);
    EXPECT_LE(users.size(), library.files)
        << library.include << " is included by " << testing::PrintToString(users);
  }
}

TEST(Layers, LibrariesStayInTheirFolders) {
  for (const auto& file : shipped()) {
    for (const auto& include : includes(file)) {
      const std::string top = include.substr(0, include.find('/'));
      const bool ours =
          top == "penumbra" || users_of_tops().contains(top) || stands_beside(file, include);
      const bool system = is_standard(include) || include.starts_with("Eigen/") ||
                          include.starts_with("sys/") || include == "unistd.h" ||
                          include == "fcntl.h";
      const bool at_home =
          std::any_of(libraries().begin(), libraries().end(), [&](const auto& library) {
            return include.starts_with(library.include) &&
                   file.path.starts_with(library.folder + "/");
          });
      EXPECT_TRUE(ours || system || at_home) << file.path << " includes " << include;
    }
  }
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
