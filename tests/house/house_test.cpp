// SPDX-License-Identifier: Apache-2.0
// What keeps the house in order: licences, sizes, packages, links.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// A text file of the source tree.
struct SourceFile {
  std::string path;  ///< relative to the repository's root, with '/'
  std::vector<std::string> lines;

  [[nodiscard]] bool ends_with(std::string_view ending) const {
    return std::string_view(path).ends_with(ending);
  }
  [[nodiscard]] bool is_cpp() const { return ends_with(".cpp") || ends_with(".hpp"); }
};

SourceFile read_source(const std::filesystem::path& root, const std::filesystem::path& file) {
  SourceFile source{std::filesystem::relative(file, root).generic_string(), {}};
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) source.lines.push_back(line);
  return source;
}

/// Files under the folders (those that exist) whose names end in one of the endings, by path.
std::vector<SourceFile> source_files(const std::vector<std::string>& folders,
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
std::vector<std::string> includes(const SourceFile& file) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::vector<std::string> found;
  for (const auto& line : file.lines) {
    if (line.find("include") == std::string::npos) continue;  // the pattern is slow
    std::smatch match;
    if (std::regex_search(line, match, pattern)) found.push_back(match[1]);
  }
  return found;
}

// The house has floors: each part of the code uses only those below it.

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

/// What includes of libraries start with, by the folder that they stay in.
const std::map<std::string, Names>& libraries() {
  static const std::map<std::string, Names> folders{
      {"penumbra/base", words("tinyxml2 hwy/")},
      {"penumbra/mesh", words("nlohmann/ meshoptimizer.h")},
      {"penumbra/render", words("meshoptimizer.h hwy/")},
      {"penumbra/labels", words("hwy/")},
      {"penumbra/render/gl", words("epoxy/egl.h dlfcn.h epoxy/gl.h")},
      {"penumbra/robot", words("fnmatch.h glob.h yaml-cpp/")},
      {"io/files", words("fnmatch.h spawn.h yaml-cpp/ png.h jpeglib.h jerror.h tiffio.h OpenEXR/ "
                         "libdeflate.h")},
      {"apps", words("malloc.h CLI/")},
      {"io", words("nlohmann/")},
      {"io/mcap", words("lz4frame.h zstd zlib.h")},
      {"io/bag", words("sqlite3.h")},
      {"io/web", words("boost/")},
      {"io/dds", words("dds/ nettle/")},
      {"sim", words("mujoco/ epoxy/egl.h")},
      {"python", words("pybind11/")},
      {"research", words("CLI/ nlohmann/ opencv2/")}};
  return folders;
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

TEST(Layers, LibrariesStayInTheirFolders) {
  const std::filesystem::path root = PENUMBRA_SOURCE_DIR;
  for (const auto& file : shipped()) {
    for (const auto& include : includes(file)) {
      const std::string top = include.substr(0, include.find('/'));
      const bool ours = top == "penumbra" || users_of_tops.contains(top) ||
                        std::filesystem::exists((root / file.path).parent_path() / include);
      const bool system = is_standard(include) || include.starts_with("Eigen/") ||
                          include.starts_with("sys/") || include == "unistd.h" ||
                          include == "fcntl.h";
      const bool at_home = std::ranges::any_of(libraries(), [&](const auto& of_folder) {
        return file.path.starts_with(of_folder.first + "/") &&
               std::ranges::any_of(of_folder.second,
                                   [&](const auto& start) { return include.starts_with(start); });
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

const std::vector<std::string> code_folders{"penumbra", "io",    "sim",    "apps",    "research",
                                            "examples", "tests", "bench",  "scripts", "cmake",
                                            ".ci",      "ros",   "python", "docs"};

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> buffer{};
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr)
    text += buffer.data();
  return text;
}

TEST(Upkeep, EveryFileNamesItsLicence) {
  const auto files = source_files(code_folders, {".cpp", ".hpp", ".sh", ".py", ".cmake",
                                                 ".cmake.in", ".hpp.in", "CMakeLists.txt"});
  ASSERT_GT(files.size(), 20U);
  for (const auto& file : files) {
    ASSERT_FALSE(file.lines.empty()) << file.path << " is empty";
    const bool script = file.lines[0].starts_with("#!");
    ASSERT_GT(file.lines.size(), script ? 1U : 0U) << file.path;
    const std::string& line = file.lines[script ? 1 : 0];
    const std::string mark = file.is_cpp() || file.ends_with(".hpp.in") ? "//" : "#";
    EXPECT_EQ(line, mark + " SPDX-License-Identifier: Apache-2.0") << file.path;
  }
}

// Every package that CMake looks for comes from a Debian package that the scripts install; those of
// ros/ are built inside of ROS.
TEST(Upkeep, PackagesAreListed) {
  std::map<std::string, std::string> debian;
  std::istringstream table(
      "Eigen3 libeigen3-dev  hwy libhwy-dev  HWY libhwy-dev  tinyxml2 libtinyxml2-dev "
      "assimp libassimp-dev  yaml-cpp libyaml-cpp-dev  PNG libpng-dev  JPEG libjpeg-dev "
      "TIFF libtiff-dev  OpenEXR libopenexr-dev  fastcdr libfastcdr-dev "
      "fastrtps libfastrtps-dev  CycloneDDS cyclonedds-dev  CLI11 libcli11-dev "
      "GTest libgtest-dev  nlohmann_json nlohmann-json3-dev  urdfdom liburdfdom-dev "
      "benchmark libbenchmark-dev  embree libembree-dev  OpenCV libopencv-calib3d-dev "
      "Threads g++  ZLIB zlib1g-dev  PkgConfig pkgconf "
      "meshoptimizer libmeshoptimizer-dev  SQLite3 libsqlite3-dev  Boost libboost-dev "
      "Python python3-dev  pybind11 pybind11-dev  OpenGL libegl-dev ");
  for (std::string package; table >> package;) table >> debian[package];
  std::set<std::string> listed;
  std::istringstream names(output_of(
      PENUMBRA_SOURCE_DIR "/scripts/packages.sh build ros python sim research test bench lint"));
  for (std::string name; names >> name;) listed.insert(name);

  const std::regex pattern(R"(^\s*find_package\(\s*([A-Za-z0-9_-]+))");
  for (const auto& file : source_files(code_folders, {"CMakeLists.txt", ".cmake"})) {
    if (file.path.starts_with("ros/")) continue;
    for (const auto& line : file.lines) {
      std::smatch match;
      if (!std::regex_search(line, match, pattern) || match[1] == "Penumbra") continue;
      const auto package = debian.find(match[1]);
      ASSERT_NE(package, debian.end()) << file.path << ": " << line << ": which Debian package?";
      EXPECT_TRUE(listed.contains(package->second))
          << file.path << " needs " << package->second << ", not in scripts/packages.sh";
    }
  }
}

TEST(Upkeep, LinksInDocumentsLeadSomewhere) {
  const std::filesystem::path root = PENUMBRA_SOURCE_DIR;
  auto documents = source_files({"docs", "examples", "ros"}, {".md"});
  for (const char* name : {"README.md", "CHANGELOG.md"})
    documents.push_back(read_source(root, root / name));
  const std::regex pattern(R"(\]\(([^)#]+)[^)]*\))");
  for (const auto& document : documents) {
    ASSERT_FALSE(document.lines.empty()) << document.path;
    const auto folder = (root / document.path).parent_path();
    for (const auto& line : document.lines) {
      for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it) {
        const std::string target = (*it)[1];
        if (target.find("://") != std::string::npos) continue;
        EXPECT_TRUE(std::filesystem::exists(folder / target)) << document.path << ": " << target;
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::test
