// SPDX-License-Identifier: Apache-2.0
// What penumbra doctor says of this machine, with OpenGL and without.
#include "../support/opengl.hpp"
#include "fixtures.hpp"

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
            (Words{"penumbra", "build", "cpu", "opengl", "renderers", "network", "libraries"}));
  EXPECT_EQ(json["penumbra"], PENUMBRA_VERSION);
  EXPECT_EQ(keys(json["build"]), (Words{"type", "compiler", "sanitizers", "opengl", "dds"}));
  EXPECT_EQ(json["cpu"]["simd"], Json(simd_target_names()));
  EXPECT_GT(json["cpu"]["threads"], 0);
  for (const Json& device : json["opengl"]["devices"])
    EXPECT_EQ(keys(device), (Words{"index", "name", "version", "vendor", "software", "fault"}));
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

}  // namespace
}  // namespace penumbra::test
