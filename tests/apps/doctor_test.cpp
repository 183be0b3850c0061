// SPDX-License-Identifier: Apache-2.0
// What penumbra doctor says of this machine, with OpenGL and without.
#include "../support/opengl.hpp"
#include "json.hpp"
#include "program.hpp"

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>

namespace penumbra::test {
namespace {

Json doctor_json(const std::vector<std::string>& environment = {}) {
  const Outcome outcome = penumbra({"doctor", "--json"}, environment);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return Json::parse(outcome.out);
}

TEST(Doctor, JsonHasTheBuildAndTheMachine) {
  const Json json = doctor_json();
  EXPECT_EQ(keys(json),
            (Keys{"penumbra", "build", "cpu", "opengl", "renderers", "network", "libraries"}));
  EXPECT_EQ(json["penumbra"], PENUMBRA_VERSION);
  EXPECT_EQ(keys(json["build"]), (Keys{"type", "compiler", "sanitizers", "opengl", "dds"}));
  EXPECT_EQ(json["cpu"]["simd"], Json(simd_target_names()));
  EXPECT_GT(json["cpu"]["threads"], 0);
  for (const Json& device : json["opengl"]["devices"])
    EXPECT_EQ(keys(device), (Keys{"index", "name", "version", "vendor", "software", "fault"}));
}

TEST(Doctor, NamesTheLibrariesThatThisProcessRuns) {
  std::set<std::string> names;
  const Json json = doctor_json();
  for (const Json& library : json["libraries"]) {
    names.insert(library["name"]);
    EXPECT_TRUE(library["version"].is_string() || library["name"] == "libepoxy" ||
                library["name"] == "Cyclone DDS")
        << library;
    if (library["file"].is_null()) continue;
    EXPECT_TRUE(std::ifstream(library["file"].get<std::string>())) << library;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"Eigen", "Highway", "tinyxml2", "meshoptimizer", "yaml-cpp",
                                   "libpng", "CLI11", "nlohmann-json", "libepoxy", "Cyclone DDS"}));
}

TEST(Doctor, TextTellsWhatJsonTells) {
  const Json json = doctor_json();
  const Outcome outcome = penumbra({"doctor"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::string> words = {"penumbra " PENUMBRA_VERSION, "  cpu (default)\n",
                                    "  reference\n",
                                    json["cpu"]["simd"][0].get<std::string>() + " (used)"};
  for (const Json& device : json["opengl"]["devices"])
    words.push_back(device[device["fault"].is_null() ? "name" : "fault"]);
  for (const Json& library : json["libraries"]) words.push_back(library["name"]);
  for (const std::string& word : words)
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " is not in\n" << outcome.out;
}

TEST(Doctor, NamesTheRenderersOfThisMachine) {
  const Json json = doctor_json();
  if (has_opengl())
    EXPECT_EQ(json["renderers"], Json::array({"cpu", "gl", "reference"}));
  else
    EXPECT_EQ(json["renderers"], Json::array({"cpu", "reference"}));
}

TEST(Doctor, SaysWhatToInstallWhereThereIsNoDriver) {
  const Json json = doctor_json(no_egl_driver);
  const Json& opengl = json["opengl"];
  for (const Json& device : opengl["devices"]) EXPECT_FALSE(device["fault"].is_null()) << device;
  EXPECT_EQ(opengl["fault"].is_null(), !opengl["devices"].empty()) << opengl;
  EXPECT_EQ(json["renderers"], Json::array({"cpu", "reference"}));

  const Outcome text = penumbra({"doctor"}, no_egl_driver);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("cannot be used"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("install"), std::string::npos) << text.out;
}

TEST(Doctor, RefusesWhatItDoesNotKnow) {
  const Outcome outcome = penumbra({"doctor", "--fast"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

}  // namespace
}  // namespace penumbra::test
