// SPDX-License-Identifier: Apache-2.0
#include "urdf_text.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

struct BadUrdf {
  const char* name;
  std::string xml;
  std::vector<std::string> says;  // parts of the message
};

void PrintTo(const BadUrdf& bad, std::ostream* out) { *out << bad.name; }

std::string name_of_case(const ::testing::TestParamInfo<BadUrdf>& info) { return info.param.name; }

class UrdfError : public ::testing::TestWithParam<BadUrdf> {};

TEST_P(UrdfError, IsOneLineThatNamesThePlace) {
  const BadUrdf& bad = GetParam();
  const std::string message = message_of([&] { (void)parse(bad.xml); });
  EXPECT_TRUE(holds(message, "robot_description"));
  for (const std::string& part : bad.says) EXPECT_TRUE(holds(message, part));
}

std::string two_links(const std::string& joint) {
  return robot_xml(link_xml("a") + link_xml("b") + joint);
}

std::string joint_with(const std::string& type, const std::string& body) {
  return two_links(joint_xml("j", type, "a", "b", body));
}

std::string shaped(const std::string& shape) {
  return robot_xml(link_xml("a", collision_xml(shape)));
}

const std::string kJoint = joint_xml("j", "fixed", "a", "b");

INSTANTIATE_TEST_SUITE_P(
    Xml, UrdfError,
    ::testing::Values(
        BadUrdf{"empty", "", {"is empty"}}, BadUrdf{"blank", " \n\t ", {"is empty"}},
        BadUrdf{"not_xml", "solid cube", {"is not XML"}},
        BadUrdf{"binary", std::string("<robot\0 name='r'/>", 18), {"zero bytes"}},
        BadUrdf{"link_name_not_utf8",
                "<robot name=\"r\">\n<link name=\"caf\xE9\"/></robot>",
                {":2: attribute name of <link> is not text in UTF-8 (byte 0xE9)", "save the file"}},
        BadUrdf{"element_not_utf8",
                "<robot name=\"r\">\n<l\xE9nk name=\"a\"/></robot>",
                {":2: ", "UTF-8"}},
        BadUrdf{"overlong_utf8",
                "<robot name=\"r\">\n<link name=\"\xE0\x80\xAF\"/></robot>",
                {":2: ", "UTF-8"}},
        BadUrdf{"surrogate_utf8",
                "<robot name=\"r\">\n<link name=\"\xED\xA0\x80\"/></robot>",
                {":2: ", "UTF-8"}},
        BadUrdf{"cut_utf8",
                "<robot name=\"r\">\n<link name=\"a\xF0\x9F\xA4\"/></robot>",
                {":2: ", "UTF-8"}},
        BadUrdf{"beyond_unicode",
                "<robot name=\"r\">\n<link name=\"\xF4\x90\x80\x80\"/></robot>",
                {":2: ", "UTF-8"}},
        BadUrdf{"unclosed", "<robot name=\"r\">\n<link name=\"a\">", {"not well-formed"}},
        BadUrdf{
            "two_documents", "<robot name=\"r\"/>\n<robot name=\"s\"/>", {":2:", "second root"}},
        BadUrdf{"text_outside",
                "<robot name=\"r\"><link name=\"a\"/></robot> tail <!-- c -->",
                {"text outside"}},
        BadUrdf{"doctype",
                "<?xml version=\"1.0\"?>\n<!-- a < b -->\n<!DOCTYPE robot>\n" + robot_xml(""),
                {":3: has a DOCTYPE (<!DOCTYPE robot)", "not accepted", "remove it"}},
        BadUrdf{"doctype_with_entities",
                "\xEF\xBB\xBF<!DOCTYPE robot [\n<?x?><!-- > --><!ENTITY a \"<b>\">]>" +
                    robot_xml(link_xml("a")),
                {":1: has a DOCTYPE (<!DOCTYPE robot)"}},
        BadUrdf{"doctype_of_a_page", "<!doctype html>\n<html></html>", {"(<!doctype html)"}},
        BadUrdf{"doctype_cut_off", "<!DOCTYPE robot", {":1: has a DOCTYPE (<!DOCTYPE robot)"}},
        BadUrdf{"declaration_inside",
                robot_xml(link_xml("a") + "<!ELEMENT link ANY>"),
                {":3:", "not well-formed", "'<!ELEMENT link ANY>'"}},
        BadUrdf{"declaration_behind",
                robot_xml(link_xml("a")) + "\n<!DOCTYPE robot>",
                {"'<!DOCTYPE robot>'", "behind the root"}},
        BadUrdf{"declaration_not_closed",
                robot_xml(link_xml("a") + "<!ELEMENT").substr(0, 60),
                {"not well-formed"}},
        BadUrdf{"comment_only", "<!-- nothing -->", {"no XML element"}},
        BadUrdf{"sdf", "<sdf version=\"1.6\"/>", {"<sdf>", "<robot>"}},
        BadUrdf{"attribute_twice", robot_xml("<link name=\"a\" name=\"b\"/>"), {":2:", "twice"}},
        BadUrdf{"no_robot_name", "<robot><link name=\"a\"/></robot>", {"\"name\" is missing"}},
        BadUrdf{"version", "<robot name=\"r\" version=\"2\"/>", {"version=\"2\""}},
        BadUrdf{"no_links", "<robot name=\"r\"/>", {"no links"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Xacro, UrdfError,
    ::testing::Values(
        BadUrdf{"element", robot_xml("<xacro:include filename=\"x\"/>"), {":2:", "xacro FILE"}},
        BadUrdf{"macro_in_ignored",
                robot_xml(link_xml("a") + "<gazebo><xacro:if/></gazebo>"),
                {":3:", "xacro FILE"}},
        BadUrdf{
            "expression", shaped("<sphere radius=\"${r}\"/>"), {":2:", "\"${r}\"", "xacro FILE"}},
        BadUrdf{"substitution", shaped("<mesh filename=\"$(find p)/x.stl\"/>"), {"xacro FILE"}},
        BadUrdf{"name", robot_xml(link_xml("${prefix}a")), {"xacro FILE"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Structure, UrdfError,
    ::testing::Values(
        BadUrdf{"element_mistyped",
                robot_xml(link_xml("a", "\n<colision/>")),
                {":3:", "link \"a\"", "\"colision\"", "\"collision\" meant"}},
        BadUrdf{"origin_mistyped",
                joint_with("fixed", "<orgin xyz=\"1 0 0\"/>"),
                {":4:", "joint \"j\"", "\"orgin\"", "\"origin\" meant"}},
        BadUrdf{"letters_swapped", joint_with("revolute", "<aixs/>"), {"\"axis\" meant"}},
        BadUrdf{"attribute_mistyped",
                shaped("<mesh fileName=\"a.stl\"/>"),
                {"\"fileName\"", "\"filename\" meant"}},
        BadUrdf{"link_without_name", robot_xml("<link/>"), {":2:", "\"name\" is missing"}},
        BadUrdf{"link_empty_name", robot_xml(link_xml("")), {"\"name\" is empty"}},
        BadUrdf{"two_links_of_a_name",
                robot_xml(link_xml("a") + link_xml("a")),
                {":3:", "link \"a\"", "line 2"}},
        BadUrdf{"two_joints_of_a_name",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") + kJoint +
                          joint_xml("j", "fixed", "a", "c")),
                {":6:", "joint \"j\"", "line 5"}},
        BadUrdf{"two_roots",
                robot_xml(link_xml("a") + link_xml("b")),
                {":3:", "link \"b\"", "second root", "\"a\""}},
        BadUrdf{"cycle_of_all", two_links(kJoint + joint_xml("k", "fixed", "b", "a")), {"cycle"}},
        BadUrdf{
            "own_parent", robot_xml(link_xml("a") + joint_xml("j", "fixed", "a", "a")), {"cycle"}},
        BadUrdf{"cycle_beside_root",
                robot_xml(link_xml("r") + link_xml("a") + link_xml("b") + kJoint +
                          joint_xml("k", "fixed", "b", "a")),
                {"link \"a\"", "cycle"}},
        BadUrdf{"two_parents",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") + kJoint +
                          joint_xml("k", "fixed", "c", "b")),
                {":6:", "joint \"k\"", "\"b\"", "by joint \"j\""}},
        BadUrdf{"unknown_parent",
                two_links(joint_xml("j", "fixed", "x", "b")),
                {":4:", "joint \"j\"", "parent link \"x\""}},
        BadUrdf{
            "unknown_child", two_links(joint_xml("j", "fixed", "a", "x")), {"child link \"x\""}},
        BadUrdf{"unknown_type", joint_with("ball", ""), {"\"ball\"", "revolute"}},
        BadUrdf{"no_type", two_links("<joint name=\"j\"/>"), {"\"type\" is missing"}},
        BadUrdf{"no_parent",
                two_links("<joint name=\"j\" type=\"fixed\"><child link=\"b\"/></joint>"),
                {"<parent> is missing"}},
        BadUrdf{"two_origins", joint_with("fixed", "<origin/><origin/>"), {"twice"}},
        BadUrdf{"name_of_two_positions",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                          joint_xml("p", "planar", "a", "b", "<axis xyz=\"0 0 1\"/>") +
                          joint_xml("p/x", "prismatic", "a", "c")),
                {"\"p/x\""}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Numbers, UrdfError,
    ::testing::Values(
        BadUrdf{"nan",
                joint_with("fixed", "<origin xyz=\"0 nan 0\"/>"),
                {":4:", "joint \"j\", origin", "xyz=\"0 nan 0\"", "3 finite numbers"}},
        BadUrdf{"inf", joint_with("fixed", "<origin rpy=\"inf 0 0\"/>"), {"rpy=\"inf 0 0\""}},
        BadUrdf{"overflow", joint_with("fixed", "<origin xyz=\"1e999 0 0\"/>"), {"1e999"}},
        BadUrdf{"hex", joint_with("fixed", "<origin xyz=\"0x10 0 0\"/>"), {"0x10"}},
        BadUrdf{"trailing_text", joint_with("fixed", "<origin xyz=\"1m 0 0\"/>"), {"1m"}},
        BadUrdf{"decimal_comma", joint_with("fixed", "<origin xyz=\"1,5 0 0\"/>"), {"1,5"}},
        BadUrdf{"too_few", joint_with("fixed", "<origin xyz=\"0 0\"/>"), {"3 finite numbers"}},
        BadUrdf{"too_many", joint_with("fixed", "<origin xyz=\"0 0 0 0\"/>"), {"3 finite numbers"}},
        BadUrdf{"empty", joint_with("fixed", "<origin xyz=\"\"/>"), {"\"xyz\" is empty"}},
        BadUrdf{"two_signs", joint_with("fixed", "<origin xyz=\"+-1 0 0\"/>"), {"+-1"}},
        BadUrdf{"millimetres", joint_with("fixed", "<origin xyz=\"2e6 0 0\"/>"), {"metres"}},
        BadUrdf{"zero_axis",
                joint_with("revolute", "<axis xyz=\"0 0 0\"/>"),
                {"axis", "no direction", "\"0 0 1\""}},
        BadUrdf{"planar_without_axis", joint_with("planar", ""), {"normal"}},
        BadUrdf{"limits_crossed",
                joint_with("revolute", "<limit lower=\"1\" upper=\"-1\"/>"),
                {"limit", "lower is above upper"}},
        BadUrdf{"limit_text", joint_with("revolute", "<limit lower=\"low\"/>"), {"\"low\""}},
        BadUrdf{"quaternion_length",
                joint_with("fixed", "<origin quat_xyzw=\"0 0 0 2\"/>"),
                {"length 1"}},
        BadUrdf{"quaternion_and_rpy",
                joint_with("fixed", "<origin quat_xyzw=\"0 0 0 1\" rpy=\"0 0 0\"/>"),
                {"both"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Mimic, UrdfError,
    ::testing::Values(
        BadUrdf{
            "unknown", joint_with("revolute", "<mimic joint=\"x\"/>"), {"joint \"j\"", "\"x\""}},
        BadUrdf{"itself", joint_with("revolute", "<mimic joint=\"j\"/>"), {"cycle"}},
        BadUrdf{"cycle",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                          joint_xml("j", "revolute", "a", "b", "<mimic joint=\"k\"/>") +
                          joint_xml("k", "revolute", "b", "c", "<mimic joint=\"j\"/>")),
                {"cycle"}},
        BadUrdf{"of_fixed",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                          joint_xml("j", "revolute", "a", "b", "<mimic joint=\"k\"/>") +
                          joint_xml("k", "fixed", "b", "c")),
                {"no single value"}},
        BadUrdf{"by_floating",
                robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                          joint_xml("j", "floating", "a", "b", "<mimic joint=\"k\"/>") +
                          joint_xml("k", "revolute", "b", "c")),
                {"more than one value"}},
        BadUrdf{"nan", joint_with("revolute", "<mimic joint=\"j\" multiplier=\"nan\"/>"), {"nan"}},
        BadUrdf{"no_joint", joint_with("revolute", "<mimic/>"), {"\"joint\" is missing"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Shapes, UrdfError,
    ::testing::Values(
        BadUrdf{"none",
                robot_xml(link_xml("a", "<collision><geometry/></collision>")),
                {"link \"a\", collision, geometry", "holds no shape"}},
        BadUrdf{"no_geometry", robot_xml(link_xml("a", "<collision/>")), {"<geometry> is missing"}},
        BadUrdf{"two", shaped("<sphere radius=\"1\"/><box size=\"1 1 1\"/>"), {"second shape"}},
        BadUrdf{"two_of_a_kind", shaped("<box size=\"1 1 1\"/><box size=\"1 1 1\"/>"), {"twice"}},
        BadUrdf{"unknown", shaped("<cone radius=\"1\"/>"), {"holds no shape", "capsule or mesh"}},
        BadUrdf{"extension_alone", shaped("<drake:ellipsoid a=\"1\"/>"), {"holds no shape"}},
        BadUrdf{"flat_box", shaped("<box size=\"1 0 1\"/>"), {"size=\"1 0 1\"", "above 0"}},
        BadUrdf{"box_of_one", shaped("<box size=\"1\"/>"), {"3 finite numbers"}},
        BadUrdf{
            "negative_radius", shaped("<sphere radius=\"-0.1\"/>"), {"radius=\"-0.1\"", "above 0"}},
        BadUrdf{
            "zero_length", shaped("<cylinder radius=\"1\" length=\"0\"/>"), {"length", "above 0"}},
        BadUrdf{"no_length", shaped("<capsule radius=\"1\"/>"), {"\"length\" is missing"}},
        BadUrdf{"huge", shaped("<sphere radius=\"1e30\"/>"), {"at most 50 m"}},
        BadUrdf{"flattened", shaped("<mesh filename=\"x.stl\" scale=\"1 1 0\"/>"), {"flattens"}},
        BadUrdf{"scale_of_one",
                shaped("<mesh filename=\"x.stl\" scale=\"0.001\"/>"),
                {"3 finite numbers"}},
        BadUrdf{"no_filename", shaped("<mesh/>"), {"\"filename\" is missing"}},
        BadUrdf{"far_away",
                robot_xml(link_xml("a", collision_xml("<box size=\"1 1 1\"/>",
                                                      "<origin xyz=\"1e7 0 0\"/>"))),
                {"1e6 m"}}),
    name_of_case);

std::string in_link(const std::string& body) { return robot_xml("\n" + link_xml("a", body)); }

// Each would be read without its prefix; a prefix must not make it vanish.
INSTANTIATE_TEST_SUITE_P(
    Prefixed, UrdfError,
    ::testing::Values(
        BadUrdf{"link", robot_xml("<u:link name=\"b\"/>" + link_xml("a")), {":2: ", "\"u:link\""}},
        BadUrdf{"joint",
                robot_xml(link_xml("a") + "<drake:joint name=\"j\" type=\"planar\"/>"),
                {":3: ", "\"drake:joint\"", "without the prefix"}},
        BadUrdf{
            "collision", in_link("<u:collision/>"), {":3: link \"a\": element \"u:collision\""}},
        BadUrdf{"visual", in_link("<u:visual/>"), {":3: link \"a\": element \"u:visual\""}},
        BadUrdf{"origin",
                in_link(collision_xml("<sphere radius=\"1\"/>", "<u:origin xyz=\"5 0 0\"/>")),
                {":3: ", "\"u:origin\""}},
        BadUrdf{"geometry", in_link("<collision><u:geometry/></collision>"), {"\"u:geometry\""}},
        BadUrdf{"capsule", shaped("<drake:capsule radius=\"1\" length=\"1\"/>"), {"capsule"}},
        BadUrdf{"mesh", shaped("<sphere radius=\"1\"/><u:mesh filename=\"x\"/>"), {"\"u:mesh\""}},
        BadUrdf{"mimic",
                joint_with("revolute", "<drake:mimic joint=\"k\"/>"),
                {"joint \"j\": element \"drake:mimic\""}},
        BadUrdf{"attribute",
                in_link(collision_xml("<sphere radius=\"1\"/>", "<origin u:xyz=\"5 0 0\"/>")),
                {":3: ", "\"u:xyz\""}}),
    name_of_case);

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

INSTANTIATE_TEST_SUITE_P(
    Names, UrdfError,
    ::testing::Values(
        BadUrdf{"link_steers", robot_xml("\n" + link_xml("a\x1b[31mRED")), {":3: ", "control"}},
        BadUrdf{"link_of_two_lines", robot_xml("\n" + link_xml("a&#10;b")), {":3: ", "control"}},
        BadUrdf{"link_deletes", robot_xml("\n" + link_xml("a\x7f")), {":3: ", "control"}},
        BadUrdf{"link_c1", robot_xml("\n" + link_xml("a&#x9b;31m")), {":3: ", "control"}},
        BadUrdf{
            "joint_steers", two_links(joint_xml("j\x1b", "fixed", "a", "b")), {":4: ", "control"}},
        BadUrdf{"robot_steers", "<robot name=\"\x1b\"/>", {":1: robot: ", "control"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    References, UrdfError,
    ::testing::Values(
        BadUrdf{"undefined",
                robot_xml("\n" + link_xml("&foo;")),
                {":3: is not well-formed XML: the entity \"&foo;\" is not defined", "&amp;"}},
        BadUrdf{"undefined_in_text", robot_xml("\n<material>&foo;</material>"), {":3: ", "&foo;"}},
        BadUrdf{"bare", robot_xml("\n" + link_xml("a & b")), {":3: ", "an & itself is"}},
        BadUrdf{"unended", robot_xml("\n" + link_xml("a&amp")), {":3: ", "begins no entity"}},
        BadUrdf{"nameless", robot_xml("\n" + link_xml("a&;")), {":3: ", "begins no entity"}},
        BadUrdf{"control", robot_xml("\n" + link_xml("a&#27;[31m")), {":3: ", "no character"}},
        BadUrdf{"zero", robot_xml("\n" + link_xml("a&#0;")), {":3: ", "no character"}},
        BadUrdf{"surrogate", robot_xml("\n" + link_xml("&#xD800;")), {":3: ", "no character"}},
        BadUrdf{"too_high", robot_xml("\n" + link_xml("&#x110000;")), {":3: ", "no character"}},
        BadUrdf{"far_too_high",
                robot_xml("\n" + link_xml("&#99999999999999999999;")),
                {":3: ", "no character"}},
        BadUrdf{"no_digits", robot_xml("\n" + link_xml("&#x;")), {":3: ", "no character"}},
        BadUrdf{"no_number", robot_xml("\n" + link_xml("&#-5;")), {":3: ", "no character"}}),
    name_of_case);

TEST(UrdfFile, ReferencesStandForTheirCharacters) {
  const std::string written =
      "&lt;&gt;&amp;&quot;&apos;&amp;foo;&#65;&#x42;&#xe9;&#x8155;&#x1F916;&#x10FFFF;";
  EXPECT_EQ(parse(robot_xml(link_xml(written))).links()[0],
            "<>&\"'&foo;AB\u00e9\u8155\U0001F916\U0010FFFF");
  EXPECT_NO_THROW((void)parse("<!-- &foo; & -->" + robot_xml(link_xml("a"))));
}

TEST(UrdfFile, CutAnywhereItIsRefusedInWords) {
  const std::string whole =
      "<?xml version=\"1.0\"?>" + robot_xml("<!-- c --><material><![CDATA[x]]>&amp;</material>" +
                                            link_xml("a", collision_xml("<sphere radius='1'/>")));
  for (std::size_t size = 0; size < whole.find("</robot>") + 8; ++size) {
    const std::string message = message_of([&] { (void)parse(whole.substr(0, size)); });
    EXPECT_EQ(message.find("XML_"), std::string::npos) << size << ": " << message;
  }
}

TEST(UrdfFile, NamesMayBeOfAnyLanguageAndCommentsOfAnyBytes) {
  const std::string names[] = {"caf\u00e9", "\u0800",     "\u8155",
                               "\ufffd",    "\U0001F916", "\U0010FFFF"};
  for (const std::string& name : names)
    EXPECT_EQ(parse("<!-- \xE9 -->" + robot_xml(link_xml(name))).links()[0], name);
}

TEST(UrdfFile, MissingIsSaid) {
  EXPECT_TRUE(holds(message_of([] { (void)Robot::load("/nowhere/x.urdf"); }), "/nowhere/x.urdf: "));
}

TEST(UrdfFile, TooLargeIsRefusedUnread) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("sparse.urdf", "");
  std::filesystem::resize_file(file, std::uintmax_t{50} << 30U);
  EXPECT_TRUE(holds(message_of([&] { (void)Robot::load(file); }), "sparse.urdf: has 53687091200"));
}

TEST(UrdfFile, TooManyElementsAreRefusedUnread) {
  std::string xml = "<robot name=\"r\">";
  for (int i = 0; i < 2'000'000; ++i) xml += "<a/>";
  EXPECT_TRUE(holds(message_of([&] { (void)parse(xml + "</robot>"); }), "tags"));
}

TEST(UrdfFile, FolderIsNoFile) {
  EXPECT_TRUE(holds(message_of([] { (void)Robot::load("/"); }), "is a folder"));
}

TEST(UrdfFile, MessagesNameFileAndLine) {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.urdf", joint_with("ball", ""));
  EXPECT_TRUE(
      holds(message_of([&] { (void)Robot::load(file); }), file.string() + ":4: joint \"j\": "));
}

TEST(UrdfFile, LongAndMultilineValuesStayOneShortLine) {
  const std::string message = message_of(
      [] { (void)parse(shaped("<sphere radius=\"1&#10;2" + std::string(10000, 'x') + "\"/>")); });
  EXPECT_LT(message.size(), 400u);
}

}  // namespace
}  // namespace penumbra::test
