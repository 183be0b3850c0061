// SPDX-License-Identifier: Apache-2.0
// Xacro files: what they expand to, by URDFs written by hand, and what is refused.
#include "../support/temporary_folder.hpp"
#include "plain_robot.hpp"
#include "urdf_text.hpp"

#include <sstream>

namespace penumbra::test {
namespace {

/// Everything that changes where a robot is drawn, as text.
std::string described(const Robot& robot) {
  std::ostringstream out;
  out.precision(15);
  for (const std::string& link : robot.links()) out << link << ' ';
  for (const Joint& joint : robot.joints()) {
    out << '\n' << joint.name << ' ' << to_string(joint.type) << ' ' << joint.parent;
    out << ' ' << joint.origin.matrix().format(Eigen::IOFormat(15, Eigen::DontAlignCols, " ", " "));
    out << ' ' << joint.axis.transpose() << ' ' << joint.lower.value_or(9) << ' '
        << joint.upper.value_or(9) << ' ' << joint.multiplier << ' ' << joint.mimics;
  }
  for (const LinkReport& link : robot.report())
    for (const std::string& source : link.sources)
      out << '\n' << link.link << ": " << source << ' ' << link.bounds.min().transpose();
  return out.str();
}

/// Returns the names of the links that a body with <link name="..."/> has, the root's left out.
std::string names_of(const std::string& body) {
  const std::string joint =
      "<xacro:macro name=\"child\" params=\"n\"><link name=\"${n}\"/><joint name=\"to_${n}\" "
      "type=\"fixed\"><parent link=\"root\"/><child link=\"${n}\"/></joint></xacro:macro>";
  const Robot robot = parse(robot_xml(link_xml("root") + joint + body));
  std::string names;
  for (const std::string& link : robot.links().subspan(1))
    names += (names.empty() ? "" : " ") + link;
  return names;
}

std::string child(const std::string& name) { return "<xacro:child n=\"" + name + "\"/>"; }

std::string property(const std::string& name, const std::string& value,
                     const std::string& rest = "") {
  return "<xacro:property name=\"" + name + "\" value=\"" + value + "\" " + rest + "/>";
}

std::string macro(const std::string& name, const std::string& params, const std::string& body) {
  return "<xacro:macro name=\"" + name + "\" params=\"" + params + "\">" + body + "</xacro:macro>";
}

TEST(Xacro, AnArmOfSeveralFilesIsTheArmWrittenOut) {
  const TemporaryFolder folder;
  folder.write("arm_description/package.xml", "<package><name>arm_description</name></package>");
  folder.write("arm_description/config/arm.yaml",
               "lengths: {upper: 0.5, lower: !millimeters 400}\n"
               "limits: &l\n  lower: !degrees -90\n  upper: !degrees 45.0\n"
               "other: {<<: *l, upper: 1}\n");
  folder.write("arm_description/urdf/inc/parts.xacro",
               "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">" +
                   macro("rod", "name length radius:=0.05 *origin",
                         "<link name=\"${prefix}${name}\"><visual><xacro:insert_block "
                         "name=\"origin\"/><geometry><cylinder radius=\"${radius}\" "
                         "length=\"${length}\"/></geometry></visual></link>") +
                   "</robot>");
  folder.write(
      "arm_description/urdf/arm.xacro",
      robot_xml(
          "<xacro:arg name=\"prefix\" default=\"a_\"/><xacro:arg name=\"tool\" default=\"false\"/>"
          "<xacro:include filename=\"$(find arm_description)/urdf/inc/*.xacro\"/>" +
          property("prefix", "$(arg prefix)") +
          property("arm", "${xacro.load_yaml('../config/arm.yaml')}") +
          macro("turning", "name parent child **more limits:=${arm.limits}",
                "<joint name=\"${prefix}${name}\" type=\"revolute\"><parent "
                "link=\"${prefix}${parent}\"/><child link=\"${prefix}${child}\"/>"
                "<limit lower=\"${limits['lower']}\" upper=\"${limits['upper']}\"/>"
                "<xacro:insert_block name=\"more\"/></joint>") +
          "<xacro:rod name=\"base\" length=\"${arm['lengths']['upper'] / 5}\"><origin/></xacro:rod>"
          "<xacro:rod name=\"upper\" length=\"${arm.lengths.upper}\"><origin xyz=\"0 0 "
          "${arm.lengths.upper / 2}\" rpy=\"0 ${pi / 2} 0\"/></xacro:rod>"
          "<xacro:turning name=\"shoulder\" parent=\"base\" child=\"upper\"><more><origin xyz=\"0 "
          "0 "
          "${0.1 + 2 * 0.05}\"/><axis xyz=\"0 1 0\"/></more></xacro:turning>"
          "<xacro:if value=\"$(arg tool)\"><xacro:rod name=\"tool\" "
          "length=\"${arm.lengths.lower}\" "
          "radius=\"0.02\"><origin/></xacro:rod>"
          "<xacro:turning name=\"wrist\" parent=\"upper\" child=\"tool\" limits=\"${arm.other}\">"
          "<more><origin xyz=\"${arm.lengths.upper} 0 0\"/></more></xacro:turning></xacro:if>"
          "<gazebo><plugin filename=\"$(find no_such_package)/x.so\"/></gazebo>"));
  const auto rod = [](const std::string& name, const std::string& origin,
                      const std::string& shape) {
    return link_xml(
        name, "<visual>" + origin + "<geometry><cylinder " + shape + "/></geometry></visual>");
  };
  const std::string arm =
      rod("b_base", "", "radius=\"0.05\" length=\"0.1\"") +
      rod("b_upper", "<origin xyz=\"0 0 0.25\" rpy=\"0 1.5707963267948966 0\"/>",
          "radius=\"0.05\" length=\"0.5\"") +
      joint_xml("b_shoulder", "revolute", "b_base", "b_upper",
                "<origin xyz=\"0 0 0.2\"/><axis xyz=\"0 1 0\"/><limit "
                "lower=\"-1.5707963267948966\" upper=\"0.7853981633974483\"/>");
  const std::string tool =
      rod("b_tool", "", "radius=\"0.02\" length=\"0.4\"") +
      joint_xml("b_wrist", "revolute", "b_upper", "b_tool",
                "<origin xyz=\"0.5 0 0\"/><limit lower=\"-1.5707963267948966\" upper=\"1\"/>");
  const auto file = folder.path() / "arm_description/urdf/arm.xacro";
  EXPECT_EQ(described(Robot::load(file, {.arguments = {{"prefix", "b_"}}})),
            described(parse(robot_xml(arm))));
  EXPECT_EQ(described(Robot::load(file, {.arguments = {{"prefix", "b_"}, {"tool", "true"}}})),
            described(parse(robot_xml(arm + tool))));
}

TEST(Xacro, WhatElementsStandFor) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {property("a", "x") + child("${a}_1"), "x_1"},
      {property("a", "${b}") + property("b", "late") + child("${a}"), "late"},
      {property("b", "1") + property("a", "${b}", "lazy_eval=\"false\"") + property("b", "2") +
           child("a${a}"),
       "a1"},
      {property("a", "1") + property("a", "2") + child("a${a}"), "a2"},
      {property("a", "1") + "<xacro:property name=\"a\" default=\"2\"/>" + child("a${a}"), "a1"},
      {"<xacro:property name=\"a\" default=\"2\"/>" + child("a${a}"), "a2"},
      {macro("m", "n:='1.50'", child("${n}_")) + "<xacro:m/><xacro:m n=\"'2.50'\"/>",
       "1.50_ 2.50_"},
      {property("a", "1.50") + child("a${a}"), "a1.5"},
      {child("$${a}"), "${a}"},
      {"<xacro:arg name=\"size\" default=\"2\"/><xacro:arg name=\"kind\" default=\"x\"/>" +
           child("$(eval size * 2 if kind == 'x' else 0)_") + child("$(eval kind + '1')"),
       "4_ x1"},
      {"<xacro:if value=\"${1 &lt; 2}\">" + child("yes") + "</xacro:if><xacro:unless value=\"1\">" +
           child("no") + "</xacro:unless>",
       "yes"},
      {macro("m", "a b:=2 c:='x y' d:=^ k:=^|5", child("${a}${b}${c[2]}${d}${k}")) +
           property("d", "D") + "<xacro:m a=\"A\"/>" + property("k", "E") +
           "<xacro:m a=\"Z\" b=\"3\"/>",
       "A2yD5 Z3yDE"},
      {property("b", "1") + property("a", "${b}", "scope=\"global\"") + property("b", "2") +
           child("a${a}"),
       "a1"},
      {property("a", "1") + "<gazebo>" + property("a", "2") + child("$(find none)") + "</gazebo>" +
           child("a${a}"),
       "a2"},
      {"<xacro:property name=\"pi\" default=\"2\"/>" + child("${pi > 3}"), "True"},
      {property("a", "x") + "<xacro:macro name=\"${a}_m\"/>" + child("${a}"), "x"},
      {macro("inner", "", child("${a}")) + macro("outer", "a", "<xacro:inner/>") +
           "<xacro:outer a=\"seen\"/>",
       "seen"},
      {macro("set", "",
             property("p", "up", "scope=\"parent\"") + property("g", "top", "scope=\"global\"")) +
           macro("outer", "", "<xacro:set/>" + child("${p}_${g}")) + "<xacro:outer/>" +
           child("${g}"),
       "up_top top"},
      {macro("both", "*one **all",
             "<xacro:insert_block name=\"one\"/><xacro:insert_block name=\"all\"/>") +
           "<xacro:both>" + joint_xml("j", "fixed", "root", "b") + "<g>" + child("a") +
           link_xml("b") + "</g></xacro:both>",
       "b a"},
      {"<xacro:property name=\"block\">" + child("a") + child("b") +
           "</xacro:property><xacro:insert_block name=\"block\"/>",
       "a b"},
      {macro("m", "n", child("${n}")) + property("which", "m") +
           "<xacro:call macro=\"${which}\" n=\"called\"/>",
       "called"},
      {"<xacro:element xacro:name=\"${'li' + 'nk'}\" name=\"e\"/>" +
           joint_xml("j", "fixed", "root", "e"),
       "e"},
      {"<link name=\"early\"><xacro:attribute name=\"name\" value=\"late\"/></link>" +
           joint_xml("j", "fixed", "root", "late"),
       "late"},
  };
  for (const auto& [body, names] : cases) {
    SCOPED_TRACE(body);
    EXPECT_EQ(names_of(body), names);
  }
}

TEST(Xacro, IncludedFilesMayHaveANamespace) {
  const TemporaryFolder folder;
  folder.write("parts.xacro",
               robot_xml(property("size", "3") + macro("add", "n", link_xml("${n}${size}"))));
  const auto file =
      folder.write("robot.xacro",
                   robot_xml(property("size", "9") +
                             "<xacro:include filename=\"parts.xacro\" ns=\"p\"/><xacro:include "
                             "filename=\"none.xacro\" optional=\"true\"/><xacro:p.add n=\"l\"/>" +
                             link_xml("m${p.size}${size}") + joint_xml("j", "fixed", "l3", "m39")));
  EXPECT_EQ(Robot::load(file).links()[1], "m39");
}

TEST(Xacro, WhatIsNotUnderstoodIsAnErrorWithItsLine) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {child("${x}"), {":3:", "\"x\"", "not defined"}},
      {child("${1 +}"), {":3:", "1 +"}},
      {child("${1"), {"not closed"}},
      {child("${(lambda: 1)()}"), {"lambda"}},
      {child("${().__class__}"), {"__class__"}},
      {child("${1 / 0}"), {"zero"}},
      {child("${'a' + 1}"), {"str and int"}},
      {child("${2 ** 999}"), {"too large"}},
      {child("${'a' * 999999999}"), {"too long"}},
      {child("${sqrt(-1)}"), {"domain"}},
      {child("$(arg none)"), {"none:=VALUE"}},
      {child("$(find no_such_package)"), {"no_such_package", "--package"}},
      {child("$(env NO_SUCH_VARIABLE)"), {"NO_SUCH_VARIABLE"}},
      {property("a", "1") + child("$(eval a)"), {"\"a\"", "not defined"}},
      {child("$(anon a)"), {"not supported"}},
      {"<xacro:unknown/>", {"\"unknown\"", "no known macro"}},
      {"<acro:child n=\"a\"/>", {"acro:child", "xacro:"}},
      {"<xacro:child/>", {"\"n\"", "not given"}},
      {"<xacro:child n=\"a\" m=\"b\"/>", {"no parameter \"m\""}},
      {"<xacro:child n=\"a\"><link name=\"b\"/></xacro:child>", {"<link>"}},
      {macro("m", "*b", "") + "<xacro:m/>", {"needs an element"}},
      {"<xacro:insert_block name=\"none\"/>", {"no block \"none\""}},
      {"<xacro:if value=\"maybe\"/>", {"\"maybe\"", "neither true nor false"}},
      {"<xacro:if value=\"0.5\"/>", {"\"0.5\""}},
      {"<xacro:if value=\"1\"><xacro:attribute name=\"a\" value=\"b\"/></xacro:if>",
       {"changes nothing"}},
      {"<xacro:include filename=\"/*/*/none\"/>", {"wildcards"}},
      {child("${1 is 1.0}"), {"=="}},
      {child("${99999999999999999999}"), {"too large"}},
      {"<xacro:if/>", {"\"value\" is missing"}},
      {"<xacro:property name=\"a\" valve=\"1\"/>", {"\"valve\""}},
      {"<xacro:include filename=\"none.xacro\"/>", {"none.xacro", "cannot be read"}},
      {child("${xacro.load_yaml('none.yaml')}"), {"none.yaml"}},
      {child("${xacro.fatal('no', 'arm')}"), {"no arm"}},
      {property("a", "${b}") + property("b", "${a}") + child("${a}"), {"made of itself"}},
      {macro("m", "", "<xacro:m/>") + "<xacro:m/>", {"without end"}},
  };
  for (const auto& [body, parts] : cases) {
    SCOPED_TRACE(body);
    const std::string message = message_of([&, &text = body] { (void)names_of(text); });
    EXPECT_TRUE(holds(message, "robot_description:"));
    for (const std::string& part : parts) EXPECT_TRUE(holds(message, part));
  }
}

// As PyYAML reads YAML 1.1; numbers in forms that other readers take differently are errors.
TEST(Xacro, YamlIsReadAsPython) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& yaml) {
    folder.write("v.yaml", yaml);
    const auto file = folder.write(
        "robot.xacro",
        robot_xml(property("y", "${xacro.load_yaml('v.yaml')}") + link_xml("${y.a} of ${len(y)}")));
    return Robot::load(file).links()[0];
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {"a: 1.50", "1.5 of 1"},
      {"a: 1e3", "1e3 of 1"},
      {"a: 1.5e+3", "1500.0 of 1"},
      {"a: '1.50'", "1.50 of 1"},
      {"a: yes", "True of 1"},
      {"a: ~", "None of 1"},
      {"a: !degrees 180", "3.141592653589793 of 1"},
      {"a: !inches 1 + 1", "0.0508 of 1"},
      {"a: x\na: y", "y of 1"},
      {"b: &b {a: 1, c: 2}\n<<: *b\nc: 3", "1 of 3"},
      {"b: &b {a: 1}\nc: &c {a: 2, d: 4}\n<<: [*b, *c]", "1 of 4"},
  };
  for (const auto& [yaml, name] : cases) {
    SCOPED_TRACE(yaml);
    EXPECT_EQ(read(yaml), name);
  }
  for (const std::string odd :
       {"010", "0x1F", "1_000", "12:30", ".inf", "!degrees [1]", "!foo 1", "[1", "1\n---\na: 2"})
    EXPECT_TRUE(holds(message_of([&] { (void)read("a: " + odd); }), "v.yaml")) << odd;
}

TEST(Xacro, ArgumentsThatNoFileUsesAreSaid) {
  const std::string xml =
      robot_xml("<xacro:arg name=\"hand\" default=\"left\"/><link name=\"$(arg hand)\"/>");
  EXPECT_EQ(parse(xml, {.arguments = {{"hand", "right"}}}).links()[0], "right");
  const std::string message = message_of([&] {
    (void)parse(xml, {.arguments = {{"hnad", "right"}}});
  });
  EXPECT_TRUE(holds(message, "\"hnad\""));
  EXPECT_TRUE(holds(message, "\"hand\" meant"));
  const Robot robot = parse(xml, {.arguments = {{"gripper", "2f85"}}});
  ASSERT_EQ(robot.notes().size(), 1U);
  EXPECT_TRUE(holds(robot.notes()[0], "\"gripper\""));
}

TEST(Xacro, FilesThatIncludeEachOtherAreRefused) {
  const TemporaryFolder folder;
  folder.write("b.xacro", robot_xml("<xacro:include filename=\"a.xacro\"/>"));
  const auto file = folder.write("a.xacro", robot_xml("<xacro:include filename=\"b.xacro\"/>"));
  EXPECT_TRUE(holds(message_of([&] { (void)Robot::load(file); }), "without end"));
}

// A billion laughs: each level makes ten of the one below.
TEST(Xacro, FilesThatGrowWithoutBoundAreRefused) {
  std::string texts = property("t0", "ha");
  std::string macros = macro("m0", "", "<g/>");
  std::string lists = property("l0", "${[1]}");
  for (int level = 1; level < 20; ++level) {
    const std::string below = std::to_string(level - 1);
    std::string text;
    std::string calls;
    std::string list;
    for (int i = 0; i < 10; ++i) {
      text += "${t" + below + "}";
      calls += "<xacro:m" + below + "/>";
      list += (i == 0 ? "${l" : " + l") + below;
    }
    texts += property("t" + std::to_string(level), text);
    macros += macro("m" + std::to_string(level), "", calls);
    lists += property("l" + std::to_string(level), list + "}");
  }
  const std::string block = "<xacro:insert_block name=\"b\"/>";
  std::string deep = property("d30", "1");
  std::string sum;
  for (int i = 0; i < 900; ++i) sum += "+1";
  for (int i = 29; i >= 0; --i)
    deep += property("d" + std::to_string(i), "${d" + std::to_string(i + 1) + sum + "}");
  EXPECT_EQ(names_of(child("a${'' * 9223372036854775807}")), "a");
  for (const std::string& body :
       {texts + child("${t19}"), macros + "<xacro:m19/>", lists + child("${len(l19)}"),
        child("${" + std::string(3000, '(') + "}"), deep + child("${d0}"),
        "<xacro:property name=\"b\">" + block + "</xacro:property>" + block})
    EXPECT_THROW((void)names_of(body), InputError);
}

}  // namespace
}  // namespace penumbra::test
