// SPDX-License-Identifier: Apache-2.0
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

/// The tiny recording with one more link on its base.
class LeniencyTest : public TinyTest {
 protected:
  void add_link(const std::string& geometry) {
    edit_file(path("tiny.urdf"), "</robot>",
              "<link name=\"more\">" + geometry +
                  "</link><joint name=\"fix\" type=\"fixed\"><parent link=\"base\"/>"
                  "<child link=\"more\"/></joint></robot>");
  }
};

constexpr const char* ball =
    "<visual><origin xyz=\"0 0 2\"/><geometry><sphere radius=\"1\"/></geometry></visual>";

TEST_F(LeniencyTest, EveryResultNamesLinksWithoutTheirMesh) {
  add_link("<collision><geometry><mesh filename=\"nowhere.stl\"/></geometry></collision>");
  for (const Outcome& outcome : {run(), render(), inspect()}) {
    EXPECT_EQ(outcome.status, 2);
    expect_has(outcome.err, {"nowhere.stl"});
  }
  const std::string allowed = "--allow-missing-meshes";

  const Outcome ran = run({allowed});
  ASSERT_EQ(ran.status, 0) << ran.err;
  expect_has(ran.err, {"missing_link in 3 of 3 frames"});
  expect_has(ran.err, {"'more'"});
  const Json json = report();
  EXPECT_EQ(json["summary"]["missing_links"], Json{"more"});
  EXPECT_EQ(json["frames"][0]["status"], "missing_link");
  expect_has(json["frames"][0]["message"], {"'more'"});

  const Outcome rendered = render({allowed, "--json"});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(rendered.err, "penumbra: missing_link: no geometry of link 'more'\n");
  EXPECT_EQ(Json::parse(rendered.out)["missing_links"], Json{"more"});

  const Outcome inspected = inspect({allowed, "--json"});
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  EXPECT_EQ(Json::parse(inspected.out)["links"][2]["missing"], true);
}

TEST_F(LeniencyTest, LinksOfTheOtherGeometryAreDrawnWhereThatIsAskedFor) {
  add_link(ball);
  const std::string fallback = "--geometry-fallback";
  const auto robot_pixels = [&](const std::string& option) {
    return Json::parse(render({option, "--json"}).out)["robot_pixels"].get<int>();
  };
  EXPECT_GT(robot_pixels(fallback), robot_pixels("--allow-missing-meshes"));
  const std::string told = run({fallback}).err;
  expect_has(told, {"do not show the robot"});
  EXPECT_EQ(told.find("only visual"), std::string::npos) << told;
  const Json link = Json::parse(inspect({fallback, "--json"}).out)["links"][2];
  EXPECT_EQ(link["drawn"], true);
  EXPECT_EQ(link["reason"], "visual, as it has no collision");
}

TEST_F(LeniencyTest, LinksOfTheOtherGeometryAreNeverLeftOutInSilence) {
  add_link(ball);
  const std::string words = "1 link has no collision geometry, only visual: \"more\"";
  for (const Outcome& outcome : {run(), render()}) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    for (const char* way : {"--geometry-fallback", "--geometry visual", "ignore_links"})
      EXPECT_NE(outcome.err.find(way), std::string::npos) << outcome.err;
  }
  const Outcome ran = run({"--allow-missing-meshes"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  expect_has(ran.err, {"missing_link in 3 of 3 frames"});
  const Json json = report();
  EXPECT_EQ(json["summary"]["missing_links"], Json{"more"});
  expect_has(json["summary"]["notes"].dump(), {"only visual"});
}

}  // namespace
}  // namespace penumbra::test
