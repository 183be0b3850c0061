// SPDX-License-Identifier: Apache-2.0
// What MuJoCo 2.2.2 cannot tell, and files that are refused.
#include "plain_robot.hpp"
#include "urdf_text.hpp"

namespace penumbra::test {
namespace {

std::string mjcf(const std::string& bodies, const std::string& sections = "") {
  return "<mujoco model=\"m\">\n" + sections + "<worldbody>\n" + bodies + "</worldbody></mujoco>\n";
}

std::string body(const std::string& content, const std::string& attributes = "name=\"a\"") {
  return "<body " + attributes + ">" + content + "</body>\n";
}

const std::string kBall = "<geom size=\"0.1\"/>";

std::vector<std::string> joint_names(const Robot& robot) {
  std::vector<std::string> names;
  for (const Joint& joint : robot.joints()) names.push_back(joint.name);
  return names;
}

std::string notes_of(const Robot& robot) {
  std::string all;
  for (const std::string& note : robot.notes()) all += note + "\n";
  return all;
}

Isometry3d pose_at(const Robot& robot, const std::string& link, const Positions& at) {
  std::vector<double> positions = robot.rest_positions();
  for (const auto& [name, value] : at) positions[*robot.find_variable(name)] = value;
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  return poses[*robot.find_link(link)];
}

TEST(Mjcf, NamesFollowTheFile) {
  const Robot robot =
      parse(mjcf(body(body("<joint/><joint axis=\"1 0 0\"/>" + kBall, "pos=\"1 0 0\"") +
                      body("<joint name=\"k\" pos=\"0 0 1\"/>" + kBall, ""))));
  EXPECT_EQ(robot.name(), "m");
  const std::vector<std::string> links(robot.links().begin(), robot.links().end());
  const std::vector<std::string> expected = {"world", "a",       "body2/body2_joint",
                                             "body2", "body3/k", "body3"};
  EXPECT_EQ(links, expected);
  const std::vector<std::string> joints = {"a_fixed", "body2_joint", "body2_joint2", "k",
                                           "body3_fixed"};
  EXPECT_EQ(joint_names(robot), joints);
}

TEST(Mjcf, FramesMoveWhatTheyContain) {
  const std::string content = "<joint name=\"j\" axis=\"1 0 0\" pos=\"0 0.5 0\"/>" + kBall;
  const Robot framed = parse(mjcf(
      "<frame pos=\"1 2 3\" euler=\"0 0 90\"><frame pos=\"1 0 0\">" +
      body("<frame pos=\"0 0 1\" euler=\"0 0 90\">" + content + "</frame>") + "</frame></frame>"));
  const Robot plain =
      parse(mjcf(body("<joint name=\"j\" axis=\"0 1 0\" pos=\"-0.5 0 1\"/><geom size=\"0.1\" "
                      "pos=\"0 0 1\"/>",
                      "name=\"a\" pos=\"1 3 3\" euler=\"0 0 90\"")));
  for (const double q : {0.0, 0.7})
    EXPECT_TRUE(pose_at(framed, "a", {{"j", q}}).isApprox(pose_at(plain, "a", {{"j", q}}), 1e-12));
  const std::size_t link = *framed.find_link("a");
  EXPECT_TRUE(framed.report()[link].bounds.isApprox(plain.report()[link].bounds, 1e-6));
}

TEST(Mjcf, FramesHaveClasses) {
  const Robot robot =
      parse(mjcf("<frame childclass=\"c\">" + body("<geom/>") + "</frame>" + body("<geom/>", ""),
                 "<default><geom size=\"0.1\"/><default class=\"c\"><geom size=\"0.3\"/></default>"
                 "</default>"));
  EXPECT_NEAR(robot.report()[1].bounds.sizes().x(), 0.6, 1e-3);
  EXPECT_NEAR(robot.report()[2].bounds.sizes().x(), 0.2, 1e-3);
}

TEST(Mjcf, FreeAndMocapBodiesFloatInTheWorld) {
  const Robot robot =
      parse(mjcf(body("<freejoint name=\"f\"/>" + kBall, "name=\"a\" pos=\"0 0 9\"") +
                 body(kBall, "name=\"b\" mocap=\"true\" pos=\"0 0 9\"")));
  EXPECT_EQ(robot.variables().size(), 14U);
  EXPECT_TRUE(pose_at(robot, "a", {{"f/x", 2.0}}).isApprox(at(2, 0, 0)));
  EXPECT_TRUE(pose_at(robot, "b", {{"b_joint/z", 1.0}}).isApprox(at(0, 0, 1)));
}

TEST(Mjcf, GeomsAreCollisionVisualOrBoth) {
  const std::string xml = mjcf(
      body("<geom size=\"0.1\"/><geom size=\"0.2\" contype=\"0\" conaffinity=\"0\" group=\"2\"/>"
           "<geom size=\"0.3\" group=\"3\"/><geom size=\"0.4\" conaffinity=\"0\" rgba=\"1 1 1 0\"/>"
           "<geom size=\"0.5\" contype=\"0\" conaffinity=\"0\" group=\"3\"/>"));
  const auto radii = [&](Geometry geometry) {
    const Robot robot = parse(xml, {.geometry = geometry});
    EXPECT_TRUE(holds(notes_of(robot), "transparent: 1"));
    return robot.report()[1].sources;
  };
  EXPECT_EQ(
      radii(Geometry::collision),
      (std::vector<std::string>{"sphere radius 0.1", "sphere radius 0.3", "sphere radius 0.4"}));
  EXPECT_EQ(radii(Geometry::visual),
            (std::vector<std::string>{"sphere radius 0.1", "sphere radius 0.2"}));
}

TEST(Mjcf, SurroundingsAreNoted) {
  const Robot robot =
      parse(mjcf("<geom type=\"plane\"/><frame><geom type=\"hfield\"/></frame>" + body(kBall)));
  EXPECT_FALSE(robot.report()[0].drawn);
  EXPECT_TRUE(holds(notes_of(robot), "geoms of the world itself"));
}

TEST(Mjcf, ConstraintsCoupleJoints) {
  const std::string joints = body(
      "<joint name=\"x\" type=\"slide\"/><joint name=\"y\" type=\"slide\" ref=\"0.5\"/>"
      "<joint name=\"z\" type=\"slide\"/>" +
      kBall);
  const auto coupled = [&](const std::string& constraint) {
    return parse(mjcf(joints, "<equality>" + constraint + "</equality>"));
  };
  const Robot fixed = coupled("<joint joint1=\"y\" polycoef=\"0.25\"/>");
  EXPECT_EQ(fixed.variables().size(), 2U);
  EXPECT_TRUE(pose_at(fixed, "a", {}).isApprox(at(0, 0, 0.25)));
  const Robot linear = coupled("<joint joint1=\"y\" joint2=\"x\" polycoef=\"0.25 2\"/>");
  EXPECT_EQ(linear.variables().size(), 2U);
  EXPECT_TRUE(pose_at(linear, "a", {{"x", 1.0}}).isApprox(at(0, 0, 1 + 0.25 + 2)));
  EXPECT_FALSE(holds(notes_of(linear), "not enforced"));
  for (const char* constraint : {"<joint joint1=\"y\" joint2=\"x\" polycoef=\"0 1 1\"/>",
                                 "<weld body1=\"a\"/>", "<tendon tendon1=\"t\"/>"}) {
    const Robot open = coupled(constraint);
    EXPECT_EQ(open.variables().size(), 3U);
    EXPECT_TRUE(holds(notes_of(open), "not enforced"));
  }
  const Robot inactive = coupled("<joint joint1=\"y\" joint2=\"x\" active=\"false\"/>");
  EXPECT_EQ(inactive.variables().size(), 3U);
  EXPECT_FALSE(holds(notes_of(inactive), "not enforced"));
}

TEST(Mjcf, MarginsEnlargeEllipsoids) {
  const std::string xml = mjcf(body("<geom type=\"ellipsoid\" size=\"0.1 0.2 0.3\"/>"));
  const Robot robot = parse(xml, {.margins = {{"a", 0.05}}});
  EXPECT_TRUE(robot.report()[1].bounds.sizes().isApprox(Vector3d(0.3, 0.5, 0.7), 1e-3));
}

// Includes: the main file's folder comes first, then the included file's.
TEST(MjcfFiles, AreIncludedAndNamed) {
  const TemporaryFolder folder;
  folder.write("parts/arm.xml",
               "<mujocoinclude><include file=\"hand.xml\"/>\n<body name=\"a\"><geom siz=\"1\"/>"
               "</body></mujocoinclude>");
  folder.write("parts/hand.xml",
               "<x><body name=\"h\"><geom type=\"mesh\" mesh=\"cube\"/></body></x>");
  folder.write("parts/assets.xml", "<mujoco><asset><mesh file=\"cube.obj\"/></asset></mujoco>");
  folder.write("meshes/parts/cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n");
  const auto file = folder.write(
      "robot.xml", mjcf("<include file=\"parts/arm.xml\"/>",
                        "<compiler meshdir=\"meshes\"/><include file=\"parts/assets.xml\"/>"));
  expect_refused([&] { (void)Robot::load(file); }, {"parts/arm.xml:2: body \"a\", geom", "size"});
  const Robot robot = Robot::load(file, {.ignore_links = {"a"}});
  EXPECT_TRUE(robot.report()[*robot.find_link("h")].drawn);
  folder.write("parts/hand.xml", "<x><include file=\"../robot.xml\"/></x>");
  expect_refused([&] { (void)Robot::load(file); },
                 {"parts/hand.xml:1: include", "includes itself"});
  folder.write("parts/hand.xml", "<x><include file=\"nowhere.xml\"/></x>");
  expect_refused([&] { (void)Robot::load(file); }, {"parts/hand.xml:1: include", "nowhere.xml"});
}

struct BadMjcf {
  std::string xml, part;
};

TEST(MjcfErrors, NameLineAndElement) {
  const auto with = [](const std::string& content) { return mjcf(body(content)); };
  const auto compiler = [](const std::string& text) {
    return mjcf(body(kBall), "<compiler " + text + "/>");
  };
  const std::vector<BadMjcf> all = {
      {compiler("coordinate=\"global\""), "coordinate"},
      {compiler("angle=\"grad\""), "angle"},
      {compiler("eulerseq=\"xyw\""), "eulerseq"},
      {compiler("angel=\"radian\""), "is \"angle\" meant?"},
      {compiler("alignfree=\"true\""), "alignfree"},
      {mjcf(""), "no bodies"},
      {mjcf(body(kBall) + body(kBall)), "already used"},
      {mjcf(body(kBall, "name=\"world\"")), "already used"},
      {mjcf(body(kBall, "quat=\"1 0 0 0\" euler=\"0 0 0\"")), "both quat and euler"},
      {mjcf(body(kBall, "quat=\"0 0 0 0\"")), "quat"},
      {mjcf(body(kBall, "childclass=\"none\"")), "childclass=\"none\""},
      {mjcf("<joint/>"), "world has no joints"},
      {mjcf("<replicate count=\"3\"/>" + body(kBall)), "<replicate> is not supported"},
      {mjcf(body(kBall), "<deformable/>"), "deformables"},
      {mjcf(body(kBall), "<default><default class=\"c\"/><default class=\"c\"/></default>"),
       "given twice"},
      {with(body("<freejoint/>" + kBall, "name=\"b\"")), "body \"b\""},
      {with("<freejoint/><joint/>" + kBall), "free joint and others"},
      {with("<freejoint align=\"true\"/>" + kBall), "align"},
      {with("<joint type=\"screw\"/>" + kBall), "screw"},
      {with("<joint axis=\"0 0 0\"/>" + kBall), "axis"},
      {with("<joint class=\"none\"/>" + kBall), "class=\"none\""},
      {with("<joint limited=\"true\" range=\"1 0\"/>" + kBall), "range"},
      {with("<geom type=\"plane\" size=\"1 1 1\"/>"), "plane"},
      {with("<geom type=\"box\" size=\"1 1\"/>"), "expected 3"},
      {with("<geom size=\"-1\"/>"), "size"},
      {with("<geom/>"), "'size' is missing"},
      {with("<geom type=\"mesh\" mesh=\"none\"/>"), "mesh=\"none\""},
      {with("<geom type=\"capsule\" size=\"1\" fromto=\"0 0 0 0 0 0\"/>"), "no length"},
      {with("<geom size=\"1\" fromto=\"0 0 0 0 0 1\"/>"), "no ends"},
      {with("<flexcomp name=\"c\"/>"), "deformable"},
      {mjcf(body("<geom type=\"capsule\" mesh=\"m\"/>"),
            "<asset><mesh name=\"m\" file=\"m.obj\"/></asset>"),
       "fitted to a mesh"},
      {mjcf(body("<geom size=\"1\" zaxis=\"1 0 0\"/>"),
            "<default><geom euler=\"0 0 9\"/></default>"),
       "default class"},
      {mjcf(body("<joint name=\"j\"/>" + kBall), "<equality><joint joint1=\"k\"/></equality>"),
       "joint1=\"k\""},
  };
  for (const BadMjcf& bad : all) {
    SCOPED_TRACE(bad.xml);
    expect_refused([&] { (void)parse(bad.xml); }, {"robot_description:", bad.part});
  }
}

TEST(MjcfErrors, DeepNestingIsRefused) {
  std::string xml;
  for (int i = 0; i < 450; ++i) xml += "<body>";
  xml += kBall;
  for (int i = 0; i < 450; ++i) xml += "</body>";
  EXPECT_NE(refusal([&] { (void)parse(mjcf(xml)); }), "");
}

bool loads(const std::string& xml) {
  return refusal([&] { (void)parse(xml, {.allow_missing_meshes = true}); }).empty();
}

TEST(MjcfFile, TruncatedAnywhereIsAnError) {
  const std::string xml =
      read_bytes(PENUMBRA_SOURCE_DIR "/tests/fuzz/seeds/mjcf/every_element.xml");
  ASSERT_TRUE(loads(xml));
  for (std::size_t size = 0; size < xml.rfind("</mujoco>"); ++size)
    ASSERT_FALSE(loads(xml.substr(0, size))) << size;
}

}  // namespace
}  // namespace penumbra::test
