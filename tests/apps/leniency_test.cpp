// SPDX-License-Identifier: Apache-2.0
#include "json.hpp"
#include "program.hpp"
#include "tiny_recording.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// The tiny recording with one more link on its base.
class LeniencyTest : public testing::Test {
 protected:
  LeniencyTest() { write_tiny_recording(folder_.path()); }

  void add_link(const std::string& geometry) {
    edit_file(file("tiny.urdf"), "</robot>",
              "<link name=\"more\">" + geometry +
                  "</link><joint name=\"fix\" type=\"fixed\"><parent link=\"base\"/>"
                  "<child link=\"more\"/></joint></robot>");
  }
  void add_link_without_mesh() {
    add_link("<collision><geometry><mesh filename=\"nowhere.stl\"/></geometry></collision>");
  }

  [[nodiscard]] std::string file(const char* name) const { return folder_.path() / name; }
  [[nodiscard]] Outcome run(const std::vector<std::string>& options) const {
    return with({"run", folder_.path(), "-o", file("out")}, options);
  }
  [[nodiscard]] Outcome render(const std::vector<std::string>& options) const {
    return with({"render", "--robot", file("tiny.urdf"), "--camera", file("camera_info.yaml"),
                 "--pose", file("camera_pose.csv"), "-o", file("vdi.npy"), "--json"},
                options);
  }
  [[nodiscard]] Outcome inspect(const std::vector<std::string>& options) const {
    return with({"inspect", file("tiny.urdf"), "--json"}, options);
  }

 private:
  static Outcome with(std::vector<std::string> line, const std::vector<std::string>& options) {
    line.insert(line.end(), options.begin(), options.end());
    return penumbra(line);
  }

  TemporaryFolder folder_;
};

TEST_F(LeniencyTest, AMissingMeshIsAnErrorUnlessItIsAllowed) {
  add_link_without_mesh();
  for (const Outcome& outcome : {run({}), render({}), inspect({})}) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("nowhere.stl"), std::string::npos) << outcome.err;
  }
}

TEST_F(LeniencyTest, EveryResultNamesLinksWithoutTheirMesh) {
  add_link_without_mesh();
  const std::vector<std::string> allowed = {"--allow-missing-meshes"};

  const Outcome ran = run(allowed);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("missing_link in 3 of 3 frames"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("'more'"), std::string::npos) << ran.err;
  const Json report = Json::parse(read_file(file("out/report.json")));
  EXPECT_EQ(report["summary"]["missing_links"], Json{"more"});
  EXPECT_EQ(report["frames"][0]["status"], "missing_link");
  EXPECT_NE(report["frames"][0]["message"].get<std::string>().find("'more'"), std::string::npos);

  const Outcome rendered = render(allowed);
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(rendered.err, "penumbra: missing_link: no geometry of link 'more'\n");
  EXPECT_EQ(Json::parse(rendered.out)["missing_links"], Json{"more"});

  const Outcome inspected = inspect(allowed);
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  EXPECT_EQ(Json::parse(inspected.out)["links"][2]["missing"], true);
}

TEST_F(LeniencyTest, LinksOfTheOtherGeometryAreDrawnWhereThatIsAskedFor) {
  add_link("<visual><origin xyz=\"0 0 2\"/><geometry><sphere radius=\"1\"/></geometry></visual>");
  const std::vector<std::string> fallback = {"--geometry-fallback"};
  const auto robot_pixels = [&](const std::vector<std::string>& options) {
    return Json::parse(render(options).out)["robot_pixels"].get<int>();
  };
  EXPECT_GT(robot_pixels(fallback), robot_pixels({"--allow-missing-meshes"}));
  const std::string told = run(fallback).err;
  EXPECT_NE(told.find("% beyond: "), std::string::npos) << "no depth image shows the sphere";
  EXPECT_EQ(told.find("only visual"), std::string::npos) << told;
  const Json link = Json::parse(inspect(fallback).out)["links"][2];
  EXPECT_EQ(link["drawn"], true);
  EXPECT_EQ(link["reason"], "visual, as it has no collision");
}

TEST_F(LeniencyTest, LinksOfTheOtherGeometryAreNeverLeftOutInSilence) {
  add_link("<visual><origin xyz=\"0 0 2\"/><geometry><sphere radius=\"1\"/></geometry></visual>");
  const std::string words = "1 link has no collision geometry, only visual: \"more\"";
  for (const Outcome& outcome : {run({}), render({})}) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    for (const char* way : {"--geometry-fallback", "--geometry visual", "ignore_links"})
      EXPECT_NE(outcome.err.find(way), std::string::npos) << outcome.err;
  }
  const Outcome ran = run({"--allow-missing-meshes"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("missing_link in 3 of 3 frames"), std::string::npos) << ran.err;
  const Json report = Json::parse(read_file(file("out/report.json")));
  EXPECT_EQ(report["summary"]["missing_links"], Json{"more"});
  EXPECT_NE(report["summary"]["notes"].dump().find("only visual"), std::string::npos);
}

TEST_F(LeniencyTest, InspectShowsLinksOfTheOtherGeometryAsMissing) {
  add_link("<visual><geometry><sphere radius=\"1\"/></geometry></visual>");
  const Outcome json = inspect({});
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(Json::parse(json.out)["links"][2]["missing"], true);
  const Outcome table = penumbra({"inspect", file("tiny.urdf")});
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_NE(table.out.find("MISSING"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("note: 1 link has no collision geometry"), std::string::npos);
}

}  // namespace
}  // namespace penumbra::test
