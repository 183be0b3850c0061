// SPDX-License-Identifier: Apache-2.0
// A URDF that cannot be drawn correctly is refused in one line with file, line and element.
#include "../support/data.hpp"
#include "plain_robot.hpp"
#include "urdf_text.hpp"

namespace penumbra::test {
namespace {

struct BadUrdf {
  std::string xml;
  std::vector<std::string> parts;  // of the message
};

void expect_all_refused(const std::vector<BadUrdf>& all) {
  for (const BadUrdf& bad : all) {
    SCOPED_TRACE(bad.xml);
    const std::string message = message_of([&] { (void)parse(bad.xml); });
    EXPECT_TRUE(holds(message, "robot_description"));
    for (const std::string& part : bad.parts) EXPECT_TRUE(holds(message, part));
  }
}

std::string two_links(const std::string& joint) {
  return robot_xml(link_xml("a") + link_xml("b") + joint);
}

std::string three_links(const std::string& joints) { return two_links(link_xml("c") + joints); }

std::string joint_with(const std::string& type, const std::string& body) {
  return two_links(joint_xml("j", type, "a", "b", body));
}

std::string shaped(const std::string& shape) {
  return robot_xml(link_xml("a", collision_xml(shape)));
}

std::string in_link(const std::string& body) { return robot_xml("\n" + link_xml("a", body)); }

const std::string kJoint = joint_xml("j", "fixed", "a", "b");

TEST(UrdfError, Xml) {
  expect_all_refused({
      {" \n\t ", {"is empty"}},
      {"solid cube", {"is not XML"}},
      {std::string("<robot\0 name='r'/>", 18), {"zero bytes"}},
      {"<robot name=\"r\">\n<link name=\"a\">", {"not well-formed"}},
      {"<robot name=\"r\"/>\n<robot name=\"s\"/>", {":2:", "root"}},
      {"<robot name=\"r\"><link name=\"a\"/></robot> tail <!-- c -->", {"root"}},
      {"<?xml version=\"1.0\"?>\n<!-- a < b -->\n<!DOCTYPE robot>\n" + robot_xml(""),
       {":3: ", "DOCTYPE", "remove it"}},
      {"<!DOCTYPE robot [<!ENTITY a \"b\">]>" + robot_xml(""), {":1: "}},
      {robot_xml(link_xml("a") + "<!ELEMENT link ANY>"), {":3:", "<!ELEMENT link ANY>"}},
      {"<!-- nothing -->", {"no XML element"}},
      {"<sdf version=\"1.6\"/>", {"<sdf>", "<robot>"}},
      {robot_xml("<link name=\"a\" name=\"b\"/>"), {":2:", "not well-formed"}},
      {"<robot><link name=\"a\"/></robot>", {"\"name\""}},
      {"<robot name=\"r\" version=\"2\"/>", {"version=\"2\""}},
      {"<robot name=\"r\"/>", {"no links"}},
  });
}

TEST(UrdfError, Structure) {
  expect_all_refused({
      {robot_xml(link_xml("a", "\n<colision/>")), {":3:", "link \"a\"", "\"collision\" meant"}},
      {joint_with("fixed", "<orgin xyz=\"1 0 0\"/>"), {":4:", "joint \"j\"", "\"origin\" meant"}},
      {shaped("<mesh fileName=\"a.stl\"/>"), {"\"fileName\"", "\"filename\" meant"}},
      {robot_xml("<link/>"), {":2:", "\"name\""}},
      {robot_xml(link_xml("")), {"\"name\""}},
      {robot_xml(link_xml("a") + link_xml("a")), {":3:", "link \"a\"", ":2:"}},
      {three_links(kJoint + joint_xml("j", "fixed", "a", "c")), {":6:", "joint \"j\"", ":5:"}},
      {robot_xml(link_xml("a") + link_xml("b")), {":3:", "link \"b\"", "second root", "\"a\""}},
      {two_links(kJoint + joint_xml("k", "fixed", "b", "a")), {"cycle"}},
      {robot_xml(link_xml("a") + joint_xml("j", "fixed", "a", "a")), {"cycle"}},
      {three_links(kJoint + joint_xml("k", "fixed", "b", "a")), {"link \"a\"", "cycle"}},
      {three_links(kJoint + joint_xml("k", "fixed", "c", "b")),
       {":6:", "joint \"k\"", "joint \"j\""}},
      {two_links(joint_xml("j", "fixed", "x", "b")), {":4:", "joint \"j\"", "link \"x\""}},
      {two_links(joint_xml("j", "fixed", "a", "x")), {"child link \"x\""}},
      {joint_with("ball", ""), {"\"ball\"", "revolute"}},
      {two_links("<joint name=\"j\"/>"), {"\"type\""}},
      {two_links("<joint name=\"j\" type=\"fixed\"><child link=\"b\"/></joint>"), {"<parent>"}},
      {joint_with("fixed", "<origin/><origin/>"), {"twice"}},
      {three_links(joint_xml("p", "planar", "a", "b", "<axis xyz=\"0 0 1\"/>") +
                   joint_xml("p/x", "prismatic", "a", "c")),
       {"\"p/x\""}},
  });
}

TEST(UrdfError, Numbers) {
  for (const std::string bad : {"0 nan 0", "inf 0 0", "1e999 0 0", "0x10 0 0", "1m 0 0", "1,5 0 0",
                                "0 0", "0 0 0 0", "+-1 0 0"})
    for (const std::string attribute : {"xyz", "rpy"}) {
      const std::string given = attribute + "=\"" + bad + "\"";
      expect_all_refused({{joint_with("fixed", "<origin " + given + "/>"),
                           {":4:", "joint \"j\", origin", given, "3 finite numbers"}}});
    }
  expect_all_refused({
      {joint_with("fixed", "<origin xyz=\"\"/>"), {"\"xyz\""}},
      {joint_with("fixed", "<origin xyz=\"2e6 0 0\"/>"), {"metres"}},
      {joint_with("revolute", "<axis xyz=\"0 0 0\"/>"), {"axis", "\"0 0 1\""}},
      {joint_with("planar", ""), {"normal"}},
      {joint_with("revolute", "<limit lower=\"1\" upper=\"-1\"/>"), {"limit", "lower"}},
      {joint_with("revolute", "<limit lower=\"low\"/>"), {"\"low\""}},
      {joint_with("fixed", "<origin quat_xyzw=\"0 0 0 2\"/>"), {"length 1"}},
      {joint_with("fixed", "<origin quat_xyzw=\"0 0 0 1\" rpy=\"0 0 0\"/>"), {"both"}},
  });
}

TEST(UrdfError, Mimic) {
  const std::string k = joint_xml("k", "revolute", "b", "c");
  expect_all_refused({
      {joint_with("revolute", "<mimic joint=\"x\"/>"), {"joint \"j\"", "\"x\""}},
      {joint_with("revolute", "<mimic joint=\"j\"/>"), {"cycle"}},
      {three_links(joint_xml("j", "revolute", "a", "b", "<mimic joint=\"k\"/>") +
                   joint_xml("k", "revolute", "b", "c", "<mimic joint=\"j\"/>")),
       {"cycle"}},
      {three_links(joint_xml("j", "revolute", "a", "b", "<mimic joint=\"k\"/>") +
                   joint_xml("k", "fixed", "b", "c")),
       {"no single value"}},
      {three_links(joint_xml("j", "floating", "a", "b", "<mimic joint=\"k\"/>") + k),
       {"more than one value"}},
      {joint_with("revolute", "<mimic joint=\"j\" multiplier=\"nan\"/>"), {"nan"}},
      {joint_with("revolute", "<mimic/>"), {"\"joint\""}},
  });
}

TEST(UrdfError, Shapes) {
  expect_all_refused({
      {in_link("<collision><geometry/></collision>"), {"link \"a\", collision, geometry"}},
      {in_link("<collision/>"), {"<geometry>"}},
      {shaped("<sphere radius=\"1\"/><box size=\"1 1 1\"/>"), {"second shape"}},
      {shaped("<box size=\"1 1 1\"/><box size=\"1 1 1\"/>"), {"twice"}},
      {shaped("<cone radius=\"1\"/>"), {"capsule or mesh"}},
      {shaped("<drake:ellipsoid a=\"1\"/>"), {"no shape"}},
      {shaped("<box size=\"1 0 1\"/>"), {"size=\"1 0 1\"", "above 0"}},
      {shaped("<box size=\"1\"/>"), {"3 finite numbers"}},
      {shaped("<sphere radius=\"-0.1\"/>"), {"radius=\"-0.1\"", "above 0"}},
      {shaped("<cylinder radius=\"1\" length=\"0\"/>"), {"length", "above 0"}},
      {shaped("<capsule radius=\"1\"/>"), {"\"length\""}},
      {shaped("<sphere radius=\"1e30\"/>"), {"at most 50 m"}},
      {shaped("<mesh filename=\"x.stl\" scale=\"1 1 0\"/>"), {"scale"}},
      {shaped("<mesh filename=\"x.stl\" scale=\"0.001\"/>"), {"3 finite numbers"}},
      {shaped("<mesh/>"), {"\"filename\""}},
      {in_link(collision_xml("<box size=\"1 1 1\"/>", "<origin xyz=\"1e7 0 0\"/>")), {"1e6 m"}},
  });
}

/// Each would be read without its prefix; a prefix must not make it vanish.
TEST(UrdfError, Prefixed) {
  const std::string sphere = "<sphere radius=\"1\"/>";
  expect_all_refused({
      {robot_xml("<u:link name=\"b\"/>" + link_xml("a")), {":2: ", "\"u:link\""}},
      {robot_xml(link_xml("a") + "<drake:joint name=\"j\" type=\"planar\"/>"),
       {":3: ", "\"drake:joint\"", "without the prefix"}},
      {in_link("<u:collision/>"), {":3: link \"a\": element \"u:collision\""}},
      {in_link("<u:visual/>"), {":3: link \"a\": element \"u:visual\""}},
      {in_link(collision_xml(sphere, "<u:origin xyz=\"5 0 0\"/>")), {":3: ", "\"u:origin\""}},
      {in_link(collision_xml(sphere, "<origin u:xyz=\"5 0 0\"/>")), {":3: ", "\"u:xyz\""}},
      {in_link("<collision><u:geometry/></collision>"), {"\"u:geometry\""}},
      {shaped("<drake:capsule radius=\"1\" length=\"1\"/>"), {"capsule"}},
      {shaped(sphere + "<u:mesh filename=\"x\"/>"), {"\"u:mesh\""}},
      {joint_with("revolute", "<drake:mimic joint=\"k\"/>"), {"joint \"j\"", "\"drake:mimic\""}},
  });
}

TEST(UrdfError, NamesWithControlCharacters) {
  for (const char* bad : {"a\x1b[31mRED", "a&#10;b", "a\x7f"})
    expect_all_refused({{robot_xml("\n" + link_xml(bad)), {":3: ", "control"}}});
  expect_all_refused({{two_links(joint_xml("j\x1b", "fixed", "a", "b")), {":4: ", "control"}},
                      {"<robot name=\"\x1b\"/>", {":1: robot: ", "control"}}});
}

TEST(UrdfFile, ReferencesStandForTheirCharacters) {
  EXPECT_EQ(parse(robot_xml(link_xml("&lt;&gt;&amp;&quot;&apos;&#65;&#x8155;"))).links()[0],
            "<>&\"'A\u8155");
  EXPECT_NO_THROW((void)parse("<!-- &foo; & \xE9 -->" + robot_xml(link_xml("\u8155"))));
}

TEST(UrdfFile, OtherToolsElementsAreAccepted) {
  const std::string link =
      link_xml("a",
               "<visual><geometry><sphere radius=\"1\"/></geometry><drake:diffuse_map v=\"x\"/>"
               "</visual><collision><geometry><sphere radius=\"1\"/></geometry>"
               "<drake:proximity_properties><drake:mu_static value=\"1\"/>"
               "</drake:proximity_properties></collision><drake:linear_bushing_rpy/>");
  const std::string more =
      "<drake:collision_filter_group name=\"g\"><drake:member link=\"a\"/>"
      "</drake:collision_filter_group><gazebo><sensor:camera name=\"c\"/><geom:box/>"
      "<body:origin u:xyz=\"1 1 1\"/><joint:hinge/></gazebo>";
  const Robot robot = parse(
      "<robot name=\"r\" xmlns:drake=\"http://d\" xmlns:name=\"http://n\" xmlns=\"http://u\">" +
      link + more + "</robot>");
  EXPECT_EQ(robot.links().size(), 1U);
}

/// What no reader of URDFs knows is ignored, and said once for each kind.
TEST(UrdfFile, UnknownElementsAreWarnings) {
  const std::string traits = "<traits kind=\"x\"/>";
  const Robot robot = parse(
      robot_xml(link_xml("a", collision_xml("<sphere radius=\"1\" diameter=\"2\"/>") + traits) +
                link_xml("b", traits + ">") +
                joint_xml("j", "fixed", "a", "b", "<controller_gains/>") + "<frame name=\"f\"/>"));
  std::string all;
  for (const std::string& note : robot.notes()) all += note + '\n';
  EXPECT_EQ(robot.notes().size(), 5U) << all;
  EXPECT_TRUE(
      holds(all, {":2: link \"a\": unknown element \"traits\"", "\"diameter\"", "text \">\"",
                  ":4: joint \"j\": unknown element \"controller_gains\"", "\"frame\""}));
}

TEST(UrdfFile, MillimetresAndDegreesAreNoted) {
  const auto notes_of = [](const std::string& origin) {
    std::string all;
    const Robot robot = parse(two_links(joint_xml("j", "fixed", "a", "b", "\n" + origin)));
    for (const std::string& note : robot.notes()) all += note + '\n';
    return all;
  };
  EXPECT_EQ(notes_of("<origin xyz=\"0 3 5\" rpy=\"-6.2832 0 3.14\"/>"), "");
  EXPECT_TRUE(holds(notes_of("<origin xyz=\"0 0 380\"/>"),
                    {":5: joint \"j\", origin: ", "380 m away", "millimetres?"}));
  EXPECT_TRUE(holds(notes_of("<origin rpy=\"0 0 -90\"/>"),
                    {":5: joint \"j\", origin: ", "rpy=\"0 0 -90\"", "degrees?"}));
  const Robot large = parse(shaped("<box size=\"150 0.5 0.5\"/>"));
  ASSERT_EQ(large.notes().size(), 1U);
  EXPECT_TRUE(holds(large.notes()[0], {"link 'a'", "150 m large", "millimetres?"}));
}

/// A box of size 0 that is never drawn.
TEST(UrdfFile, GeometryThatIsNotDrawnIsNotChecked) {
  const std::string xml = robot_xml(
      link_xml("a", collision_xml("<sphere radius=\"1\"/>") + visual_xml("<box size=\"0 0 0\"/>")));
  EXPECT_EQ(parse(xml).links().size(), 1U);
  expect_refused([&] { (void)parse(xml, {.geometry = Geometry::visual}); },
                 {"link \"a\", visual, geometry, box"});
  RobotOptions options{.geometry = Geometry::visual};
  options.allow_missing_meshes = true;
  EXPECT_TRUE(holds(parse(xml, options).report()[0].fault, "size=\"0 0 0\""));
}

TEST(UrdfFile, IsNamedWithItsLine) {
  const TemporaryFolder folder;
  const auto bad = folder.write("bad.urdf", joint_with("ball", ""));
  expect_refused([&] { (void)Robot::load(bad); }, {bad.string() + ":4: joint \"j\": "});
}

// Whether it was read. Meshes are not at hand: only their absence may be forgiven.
bool survives(const std::string& xml) {
  return refusal([&] { (void)parse(xml, {.allow_missing_meshes = true}); }).empty();
}

/// The seeds of the fuzzers and, where the data are, a real robot's.
std::vector<std::string> urdfs() {
  const std::filesystem::path seeds = PENUMBRA_SOURCE_DIR "/tests/fuzz/seeds";
  std::vector<std::string> all{read_bytes(seeds / "urdf/everything.urdf"),
                               read_bytes(seeds / "xacro/everything.xacro")};
  if (has_data()) all.push_back(read_bytes(data_folder() / "robots/ur5e/ur5e.urdf"));
  return all;
}

TEST(UrdfFuzz, TruncatedAnywhereIsAnError) {
  for (const std::string& xml : urdfs()) {
    const std::size_t end = xml.rfind("</robot>") + std::string("</robot>").size();
    for (std::size_t size = 0; size < end; ++size)
      ASSERT_FALSE(survives(xml.substr(0, size))) << "cut to " << size << " bytes it was read";
    EXPECT_TRUE(survives(xml.substr(0, end)));
  }
}

TEST(UrdfFuzz, DeepNestingIsRefused) {
  std::string xml = "<robot name=\"r\">";
  for (int i = 0; i < 100000; ++i) xml += "<gazebo>";
  EXPECT_FALSE(survives(xml));
}

}  // namespace
}  // namespace penumbra::test
