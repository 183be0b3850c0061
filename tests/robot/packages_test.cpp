// SPDX-License-Identifier: Apache-2.0
#include "urdf_text.hpp"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr const char* kVariables[] = {"AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH", "GAZEBO_MODEL_PATH",
                                      "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH"};

/// Packages whose meshes differ in size, so that the bounds tell which was taken.
class Packages : public ::testing::Test {
 protected:
  void SetUp() override { clear(); }
  void TearDown() override { clear(); }

  static void clear() {
    for (const char* variable : kVariables) ::unsetenv(variable);
  }

  void add_mesh(const std::string& file, double size) {
    folder_.write(file, tetrahedron_stl(size));
  }

  void add_manifest(const std::string& folder, const std::string& name) {
    folder_.write(folder + "/package.xml", "<package><name> " + name + " </name></package>");
  }

  void set(const char* variable, const std::string& value) { ::setenv(variable, value.c_str(), 1); }

  std::string in(const std::string& name) const { return (folder_.path() / name).string(); }

  Robot load(const std::string& mesh, const RobotOptions& options = {},
             const std::string& urdf = "work/robots/r.urdf") {
    return Robot::load(
        folder_.write(urdf,
                      robot_xml(link_xml("a", collision_xml("<mesh filename=\"" + mesh + "\"/>")))),
        options);
  }

  double size_of(const Robot& robot) { return robot.report()[0].bounds.max().x(); }

  TemporaryFolder folder_;
};

TEST_F(Packages, GivenFolderGoesFirstAndNeedsNoNote) {
  add_mesh("given/m/t.stl", 1);
  add_mesh("prefix/share/p/m/t.stl", 2);
  set("AMENT_PREFIX_PATH", in("prefix"));
  const Robot robot = load("package://p/m/t.stl", {.packages = {{"p", in("given")}}});
  EXPECT_EQ(size_of(robot), 1.0);
  EXPECT_TRUE(robot.notes().empty());
}

TEST_F(Packages, GivenFolderMustExist) {
  EXPECT_TRUE(holds(message_of([&] {
                      (void)load("package://p/t.stl", {.packages = {{"p", in("nil")}}});
                    }),
                    "which is no folder"));
}

TEST_F(Packages, AmentPrefixesInTheirOrder) {
  add_mesh("two/share/p/t.stl", 2);
  add_mesh("three/share/p/t.stl", 3);
  set("AMENT_PREFIX_PATH", in("one") + "::" + in("two") + ":" + in("three"));
  const Robot robot = load("package://p/t.stl");
  EXPECT_EQ(size_of(robot), 2.0);
  ASSERT_EQ(robot.notes().size(), 1u);
  EXPECT_EQ(robot.notes()[0],
            "package p: taken from " + in("two/share/p") + " (by AMENT_PREFIX_PATH)");
}

TEST_F(Packages, RosPackagePathIsSearchedInDepthByManifest) {
  add_mesh("src/stack/folder/t.stl", 4);
  add_manifest("src/stack/folder", "p");
  set("ROS_PACKAGE_PATH", in("src"));
  const Robot robot = load("package://p/t.stl");
  EXPECT_EQ(size_of(robot), 4.0);
  EXPECT_TRUE(holds(robot.notes()[0], "(by ROS_PACKAGE_PATH)"));
  EXPECT_EQ(size_of(load("package://folder/t.stl")), 4.0);
}

TEST_F(Packages, RosPackagePathSkipsIgnoredFoldersAndSurvivesLinksInACircle) {
  add_mesh("src/old/p/t.stl", 5);
  add_manifest("src/old/p", "p");
  folder_.write("src/old/CATKIN_IGNORE", "");
  add_mesh("src/z/p/t.stl", 6);
  add_manifest("src/z/p", "p");
  std::filesystem::create_directory_symlink(in("src"), in("src/circle"));
  set("ROS_PACKAGE_PATH", in("src"));
  EXPECT_EQ(size_of(load("package://p/t.stl")), 6.0);
}

TEST_F(Packages, BrokenManifestCountsByItsFolder) {
  add_mesh("src/p/t.stl", 7);
  folder_.write("src/p/package.xml", "<package><name>");
  set("ROS_PACKAGE_PATH", in("src"));
  EXPECT_EQ(size_of(load("package://p/t.stl")), 7.0);
}

TEST_F(Packages, FoundBesideTheUrdf) {
  add_mesh("work/robots/p/t.stl", 8);
  const Robot robot = load("package://p/t.stl");
  EXPECT_EQ(size_of(robot), 8.0);
  EXPECT_TRUE(holds(robot.notes()[0], "found beside or above the URDF"));
}

TEST_F(Packages, FoundBesideAUrdfOfTheWorkingFolder) {
  add_mesh("work/robots/p/t.stl", 8);
  static_cast<void>(load("package://p/t.stl"));
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(in("work/robots"));
  EXPECT_EQ(size_of(Robot::load("r.urdf")), 8.0);
  std::filesystem::current_path(before);
}

TEST_F(Packages, FoundAboveTheUrdfWhereTheFileIs) {
  add_mesh("p/t.stl", 9);
  folder_.write("work/p/another.txt", "");
  EXPECT_EQ(size_of(load("package://p/t.stl")), 9.0);
}

TEST_F(Packages, TheUrdfMayLieInThePackageItself) {
  add_mesh("p/meshes/t.stl", 10);
  EXPECT_EQ(size_of(load("package://p/meshes/t.stl", {}, "p/urdf/r.urdf")), 10.0);
  add_mesh("p-main/meshes/t.stl", 11);
  add_manifest("p-main", "q");
  EXPECT_EQ(size_of(load("package://q/meshes/t.stl", {}, "p-main/urdf/r.urdf")), 11.0);
}

TEST_F(Packages, ModelUriLooksInModelPathsToo) {
  add_mesh("models/m/meshes/t.stl", 12);
  set("GAZEBO_MODEL_PATH", in("models"));
  const Robot robot = load("model://m/meshes/t.stl");
  EXPECT_EQ(size_of(robot), 12.0);
  EXPECT_TRUE(holds(robot.notes()[0], "GAZEBO_MODEL_PATH"));
  EXPECT_TRUE(holds(message_of([&] { (void)load("package://m/meshes/t.stl"); }), "not found"));
}

TEST_F(Packages, OnePackageIsNotedOnce) {
  add_mesh("work/robots/p/t.stl", 1);
  add_mesh("work/robots/p/u.stl", 1);
  const auto file = folder_.write(
      "work/robots/r.urdf",
      robot_xml(link_xml("a", collision_xml("<mesh filename=\"package://p/t.stl\"/>") +
                                  collision_xml("<mesh filename=\"package://p/u.stl\"/>") +
                                  collision_xml("<mesh filename=\"package://p/t.stl\"/>"))));
  const Robot robot = Robot::load(file);
  EXPECT_EQ(robot.notes().size(), 1u);
  EXPECT_EQ(robot.meshes(0).size(), 3u);
}

TEST_F(Packages, UnknownPackageAndMissingFileAreSaid) {
  const std::string unknown = message_of([&] { (void)load("package://p/t.stl"); });
  EXPECT_TRUE(holds(unknown, "package \"p\" was not found"));
  EXPECT_TRUE(holds(unknown, "--package p=DIR"));
  add_mesh("given/t.stl", 1);
  EXPECT_TRUE(holds(message_of([&] {
                      (void)load("package://p/u.stl", {.packages = {{"p", in("given")}}});
                    }),
                    "no file at " + in("given/u.stl")));
}

TEST_F(Packages, MalformedUriIsSaid) {
  for (const char* uri : {"package://", "package:///t.stl", "package://p", "package://p/"})
    EXPECT_TRUE(holds(message_of([&] { (void)load(uri); }), "not of the form")) << uri;
}

}  // namespace
}  // namespace penumbra::test
