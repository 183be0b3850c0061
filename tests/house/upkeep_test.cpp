// SPDX-License-Identifier: Apache-2.0
// What keeps the house in order: licences, sizes, packages, links.
#include "source_tree.hpp"

#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

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
  auto documents = source_files({"docs", "examples"}, {".md"});
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
