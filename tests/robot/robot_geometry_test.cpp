// SPDX-License-Identifier: Apache-2.0
#include "../mesh/mesh_oracle.hpp"
#include "../mesh/mesh_samples.hpp"
#include "urdf_text.hpp"

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

// Vertices are rounded to float once, at about a metre.
constexpr double kVertexTolerance = 1e-6;

const std::string unit_tetrahedron = ascii_stl(tetrahedron(1, 1, 1));

const LinkReport& report_of(const Robot& robot, const std::string& link) {
  return robot.report()[*robot.find_link(link)];
}

void expect_bounds(const LinkReport& report, const Vector3d& low, const Vector3d& high) {
  EXPECT_LT((report.bounds.min() - low).norm(), kVertexTolerance) << report.bounds.min();
  EXPECT_LT((report.bounds.max() - high).norm(), kVertexTolerance) << report.bounds.max();
}

// a: collision box and visual sphere; b: visual only; c: nothing; d: collision only.
std::string four_links() {
  const std::string box = "<box size=\"1 1 1\"/>";
  return robot_xml(link_xml("a", collision_xml(box) + visual_xml("<sphere radius=\"0.1\"/>")) +
                   link_xml("b", visual_xml(box)) + link_xml("c") +
                   link_xml("d", collision_xml(box)) + joint_xml("ab", "fixed", "a", "b") +
                   joint_xml("bc", "fixed", "b", "c") + joint_xml("cd", "fixed", "c", "d"));
}

std::string drawn(const RobotOptions& options) {
  const Robot robot = parse(four_links(), options);
  std::string names;
  for (const LinkReport& report : robot.report())
    if (report.drawn) names += report.link;
  return names;
}

TEST(LinkChoice, GeometryIsTheOneAskedFor) {
  EXPECT_EQ(drawn({}), "abd") << "b has only visual geometry";
  EXPECT_EQ(drawn({.geometry = Geometry::collision, .ignore_links = {"b"}}), "ad");
  EXPECT_EQ(drawn({.geometry = Geometry::visual, .ignore_links = {"d"}}), "ab");
  EXPECT_EQ(drawn({.geometry_of_links = {{"b", Geometry::visual}}}), "abd");
  EXPECT_EQ(drawn({.geometry = Geometry::visual, .geometry_fallback = true}), "abd");
  EXPECT_EQ(drawn({.ignore_links = {"[ab]"}}), "d");
  EXPECT_EQ(drawn({.only_links = {"a", "c"}}), "a");
  EXPECT_EQ(drawn({.ignore_links = {"a", "b"}, .only_links = {"*"}}), "d");
}

TEST(LinkChoice, ExtraMeshesAreDrawnWithTheirLinksAndNamed) {
  const TemporaryFolder folder;
  const auto mesh = folder.write("tool.stl", unit_tetrahedron);
  const Robot robot =
      parse(four_links(), {.ignore_links = {"b"}, .extra = {{"c", mesh}, {"d", mesh}}});
  const LinkReport& c = report_of(robot, "c");
  EXPECT_TRUE(c.drawn);
  EXPECT_EQ(c.sources, std::vector<std::string>{mesh.string()});
  expect_bounds(c, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(report_of(robot, "d").sources.size(), 2U);
  expect_bounds(report_of(robot, "d"), {-0.5, -0.5, -0.5}, {1, 1, 1});
}

TEST(LinkChoice, ReportSaysWhyALinkIsNotDrawn) {
  const Robot robot =
      parse(four_links(),
            {.geometry = Geometry::collision, .ignore_links = {"d"}, .allow_missing_meshes = true});
  EXPECT_EQ(report_of(robot, "a").reason, "collision");
  EXPECT_EQ(report_of(robot, "b").reason, "has no collision, only visual");
  EXPECT_EQ(report_of(robot, "c").reason, "has no geometry");
  EXPECT_EQ(report_of(robot, "d").reason, "ignored by ignore_links");
  EXPECT_TRUE(robot.meshes(*robot.find_link("d")).empty());
  EXPECT_TRUE(report_of(robot, "d").bounds.isEmpty());
}

TEST(LinkChoice, LinksThatLackTheChosenGeometryAreRefusedWithTheWaysOut) {
  const auto refused = [](const RobotOptions& options) {
    return message_of([&] { (void)parse(four_links(), options); });
  };
  EXPECT_TRUE(holds(refused({.geometry = Geometry::collision}),
                    {"robot_description: ", "no collision geometry", "\"b\"", "ignore_links"}));
  EXPECT_TRUE(holds(refused({.geometry_of_links = {{"b", Geometry::collision}}}), "\"b\""));
  EXPECT_TRUE(holds(refused({.geometry = Geometry::visual}), "\"d\""));
  const Robot usual = parse(four_links());
  ASSERT_EQ(usual.notes().size(), 1U);
  EXPECT_TRUE(holds(usual.notes()[0], {"\"b\"", "ignore_links"}));
  for (const RobotOptions& way :
       {RobotOptions{.geometry_of_links = {{"b", Geometry::visual}}},
        RobotOptions{.geometry_fallback = true}, RobotOptions{.ignore_links = {"b"}},
        RobotOptions{.only_links = {"a", "c", "d"}}}) {
    const Robot robot = parse(four_links(), way);
    EXPECT_TRUE(robot.notes().empty());
    for (const LinkReport& report : robot.report()) EXPECT_FALSE(report.missing) << report.link;
  }
}

TEST(LinkChoice, NameGoesBeforePatternsAndPatternsMustAgree) {
  RobotOptions options{.geometry_fallback = true, .margins = {{"*", 0.01}, {"a", 0.02}}};
  EXPECT_EQ(report_of(parse(four_links(), options), "a").margin, 0.02);
  EXPECT_EQ(report_of(parse(four_links(), options), "d").margin, 0.01);
  options.margins = {{"*", 0.01}, {"[ad]", 0.02}};
  expect_refused([&] { (void)parse(four_links(), options); },
                 {"\"*\" and \"[ad]\" have different values"});
}

TEST(Geometry, EveryElementOfALinkIsDrawn) {
  const Robot robot = parse(robot_xml(
      link_xml("a", collision_xml("<box size=\"1 2 3\"/>") +
                        collision_xml("<cylinder radius=\"0.5\" length=\"2\"/>") +
                        collision_xml("<sphere radius=\"0.25\"/>", "<origin xyz=\"0 0 5\"/>") +
                        collision_xml("<capsule radius=\"0.1\" length=\"0.5\"/>"))));
  ASSERT_EQ(robot.meshes(0).size(), 4u);
  const LinkReport& report = robot.report()[0];
  EXPECT_EQ(report.sources,
            (std::vector<std::string>{"box 1 x 2 x 3", "cylinder radius 0.5 length 2",
                                      "sphere radius 0.25", "capsule radius 0.1 length 0.5"}));
  EXPECT_TRUE(report.watertight);
  std::size_t triangles = 0;
  for (const TriangleMesh& mesh : robot.meshes(0)) triangles += mesh.triangles.size();
  EXPECT_EQ(report.triangles, triangles);
  EXPECT_NEAR(report.bounds.max().z(), 5.25, 2e-4);  // round shapes have a chord error
}

class MeshFiles : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("meshes/t.stl", unit_tetrahedron); }

  Robot load(const std::string& mesh, const RobotOptions& options = {},
             const std::string& origin = "") {
    const auto file = folder_.write(
        "r.urdf", robot_xml(link_xml("a", collision_xml("<mesh " + mesh + "/>", origin))));
    return Robot::load(file, options);
  }

  TemporaryFolder folder_;
};

TEST_F(MeshFiles, ScaleComesBeforeOrigin) {
  const Robot robot = load("filename=\"meshes/t.stl\" scale=\"1 2 3\"", {},
                           "<origin xyz=\"0 0 1\" rpy=\"0 0 1.5707963267948966\"/>");
  expect_bounds(robot.report()[0], {-2, 0, 1}, {0, 1, 4});
  EXPECT_EQ(robot.report()[0].triangles, 4u);
}

TEST_F(MeshFiles, MirroredMeshKeepsItsOutside) {
  for (const char* scale : {"1 1 1", "-1 1 1", "1 -1 1", "-1 -1 1", "-1 -2 -3"}) {
    const Robot robot = load(std::string("filename=\"meshes/t.stl\" scale=\"") + scale + "\"");
    EXPECT_GT(signed_volume(robot.meshes(0)[0]), 0.1) << scale;
    EXPECT_TRUE(robot.report()[0].watertight);
  }
}

TEST_F(MeshFiles, EveryFormOfPathIsFound) {
  folder_.write("meshes/UPPER CASE.STL", unit_tetrahedron);
  const std::string absolute = (folder_.path() / "meshes/t.stl").string();
  for (const std::string& name : std::vector<std::string>{
           "meshes/t.stl", "./meshes/../meshes/t.stl", absolute, "file://" + absolute,
           "file://localhost" + absolute, "FILE://" + absolute, "file://meshes/t.stl",
           "meshes/UPPER CASE.STL", "meshes/UPPER%20CASE.STL"})
    EXPECT_TRUE(load("filename=\"" + name + "\"").report()[0].drawn) << name;
}

TEST_F(MeshFiles, ThatCannotBeDrawnAreRefusedWithLinkAndFile) {
  folder_.write("meshes/bad.stl", "solid nothing");
  const auto expect = [&](const std::string& mesh, const std::string& part) {
    const std::string message = message_of([&] { (void)load(mesh); });
    EXPECT_TRUE(holds(message, "r.urdf:2: link \"a\"")) << mesh;
    EXPECT_TRUE(holds(message, part)) << mesh;
  };
  expect("filename=\"meshes/u.stl\"", "no file at " + (folder_.path() / "meshes/u.stl").string());
  expect("filename=\"meshes\"", "no file at");
  expect("filename=\"meshes/bad.stl\"", "meshes/bad.stl");
  expect("filename=\"https://x.org/t.stl\"", "https://");
  expect("filename=\"meshes/t.stl\" scale=\"1e-60 1e-60 1e-60\"", "area");
  expect("filename=\"meshes/t.stl\" scale=\"1e300 1e300 1e300\"", "1e6 m");
}

TEST(Geometry, LinksThatAreTinyAsAWholeAreNoted) {
  using Notes = std::vector<std::string>;
  const auto notes_of = [](const std::string& shapes, const RobotOptions& options = {}) {
    const Robot robot = parse(robot_xml(link_xml("a", shapes)), options);
    return Notes(robot.notes().begin(), robot.notes().end());
  };
  const std::string tiny = collision_xml("<box size=\"0.0009 0.0009 0.0001\"/>");
  const Notes told{"link 'a': its geometry is only 0.9 mm large; check the unit"};
  EXPECT_EQ(notes_of(tiny), told);
  EXPECT_EQ(notes_of(tiny + tiny), told);
  EXPECT_EQ(notes_of(tiny, {.margins = {{"a", 0.01}}}), told) << "a margin is no geometry";
  EXPECT_EQ(notes_of(tiny + collision_xml("<sphere radius=\"0.1\"/>")), Notes{});
  EXPECT_EQ(notes_of(collision_xml("<box size=\"0.0001 0.0001 0.0021\"/>")), Notes{});
}

TEST_F(MeshFiles, MissingMeshMayBeAllowedAndIsReported) {
  const auto file = folder_.write(
      "r.urdf", robot_xml(link_xml("a", collision_xml("<mesh filename=\"meshes/t.stl\"/>") +
                                            collision_xml("<mesh filename=\"u.stl\"/>")) +
                          link_xml("b", collision_xml("<mesh filename=\"package://q/u.stl\"/>")) +
                          joint_xml("j", "fixed", "a", "b")));
  const Robot robot = Robot::load(file, {.allow_missing_meshes = true});
  EXPECT_EQ(robot.urdf(), file);
  EXPECT_TRUE(robot.options().allow_missing_meshes);
  const LinkReport& a = report_of(robot, "a");
  EXPECT_TRUE(a.drawn);
  EXPECT_TRUE(a.missing);
  EXPECT_TRUE(holds(a.reason, "missing: no file at"));
  const LinkReport& b = report_of(robot, "b");
  EXPECT_FALSE(b.drawn);
  EXPECT_TRUE(b.missing);
  EXPECT_TRUE(holds(b.reason, "package \"q\" was not found"));
  EXPECT_TRUE(holds(b.fault, "r.urdf:3: link \"b\": package \"q\" was not found"));
}

TEST(Geometry, MarginsOfPrimitivesAreTheirDimensions) {
  constexpr double rounding = 4 * primitive_error;
  for (const std::string shape :
       {"<box size=\"0.1 0.2 0.3\"/>", "<cylinder radius=\"0.1\" length=\"0.6\"/>",
        "<sphere radius=\"0.2\"/>", "<capsule radius=\"0.1\" length=\"0.8\"/>"}) {
    const std::string xml = robot_xml(link_xml("a", collision_xml(shape)));
    const LinkReport plain = parse(xml).report()[0];
    for (const double margin : {0.01, -0.04}) {
      const LinkReport report = parse(xml, {.margins = {{"a", margin}}}).report()[0];
      const Vector3d growth = report.bounds.sizes() - plain.bounds.sizes();
      EXPECT_LT((growth.array() - 2.0 * margin).abs().maxCoeff(), rounding) << shape;
      EXPECT_EQ(report.sources, plain.sources);
    }
  }
}

TEST_F(MeshFiles, NothingLeftOfAGeometryIsAnErrorOfTheLink) {
  const auto said = [](const std::string& shape) {
    return message_of([&] {
      (void)parse(robot_xml(link_xml("a", collision_xml(shape))), {.margins = {{"a", -0.2}}});
    });
  };
  const std::string mesh = (folder_.path() / "meshes/t.stl").string();
  for (const std::string shape :
       {"<box size=\"1 0.4 1\"/>", "<sphere radius=\"0.1\"/>",
        "<cylinder radius=\"1\" length=\"0.3\"/>", "<capsule radius=\"0.2\" length=\"1\"/>"})
    EXPECT_TRUE(holds(said(shape), "link \"a\": ") && holds(said(shape), "margin of -0.2 m"))
        << shape;
  EXPECT_TRUE(
      holds(said("<mesh filename=\"" + mesh + "\" scale=\"0.5 0.5 0.5\"/>"), "leaves nothing"));
}

TEST_F(MeshFiles, NegativeMarginOfAnOpenMeshIsAnErrorOfTheLink) {
  folder_.write("open.stl",
                "solid o\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                "vertex 0 1 0\nendloop\nendfacet\nendsolid o\n");
  const RobotOptions options{.margins = {{"a", -0.01}}, .allow_missing_meshes = true};
  expect_refused([&] { (void)load("filename=\"open.stl\"", options); }, {"link \"a\""});
  EXPECT_FALSE(load("filename=\"open.stl\"").report()[0].watertight);
}

}  // namespace
}  // namespace penumbra::test
