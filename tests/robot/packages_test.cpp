// SPDX-License-Identifier: Apache-2.0
#include "../mesh/mesh_samples.hpp"
#include "urdf_text.hpp"

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
    folder_.write(file, ascii_stl(tetrahedron(float(size), 1, 1)));
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

TEST_F(Packages, AreFoundByNameManifestOrPlace) {
  struct Case {
    std::string mesh, manifest, variable, folder, uri, urdf, note;
  };
  const std::string urdf = "work/robots/r.urdf", ros = "ROS_PACKAGE_PATH",
                    gazebo = "GAZEBO_MODEL_PATH", uri = "package://p/t.stl";
  double size = 0;  // of each mesh
  for (const Case& each : std::initializer_list<Case>{
           {"a/share/p/t.stl", "", ros, "a/share", uri, urdf, ros},
           {"c/models/p/t.stl", "", gazebo, "c/models", "model://p/t.stl", urdf, gazebo},
           {"d/p/t.stl", "", "", "", uri, "d/work/r.urdf", "above the URDF"},
           {"e/p/t.stl", "", "", "", uri, "e/p/urdf/r.urdf", ""},
           {"f/p-main/t.stl", "f/p-main", "", "", uri, "f/p-main/urdf/r.urdf", ""}}) {
    SCOPED_TRACE(each.mesh);
    clear();
    add_mesh(each.mesh, ++size);
    if (!each.manifest.empty())
      folder_.write(each.manifest + "/package.xml", "<package><name> p </name></package>");
    if (!each.variable.empty()) set(each.variable.c_str(), in(each.folder));
    const Robot robot = load(each.uri, {}, each.urdf);
    EXPECT_EQ(size_of(robot), size);
    EXPECT_TRUE(holds(robot.notes()[0], each.note));
  }
}

TEST_F(Packages, ANameThatNoPackageHasIsTheOnlyFolderOfThatNameInMeshes) {
  const std::string uri = "package://collision/t.stl", urdf = "g/urdf/r.urdf";
  add_mesh("g/meshes/one/collision/t.stl", 3);
  const Robot robot = load(uri, {}, urdf);
  EXPECT_EQ(size_of(robot), 3.0);
  EXPECT_TRUE(holds(robot.notes()[0], in("g/meshes/one/collision")));
  add_mesh("g/meshes/two/collision/u.stl", 4);
  expect_refused([&] { (void)load(uri, {}, urdf); },
                 {"package \"collision\" was not found", "--package collision=DIR"});
}

}  // namespace
}  // namespace penumbra::test
