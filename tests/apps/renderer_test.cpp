// SPDX-License-Identifier: Apache-2.0
// What penumbra doctor says of this machine, and --renderer and --gl-device: what is taken, what
// the report says of it, what is refused.
#include "../support/opengl.hpp"
#include "fixtures.hpp"

#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

Json doctor_json(const Words& environment = {}) {
  const Outcome outcome = succeed(penumbra({"doctor", "--json"}, environment));
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
  EXPECT_EQ(json["renderers"],
            has_opengl() ? Json({"cpu", "gl", "reference"}) : Json({"cpu", "reference"}));
}

TEST(Doctor, SaysWhatToInstallWhereThereIsNoDriver) {
  const Json json = doctor_json(no_egl_driver);
  const Json& opengl = json["opengl"];
  for (const Json& device : opengl["devices"]) EXPECT_FALSE(device["fault"].is_null()) << device;
  EXPECT_EQ(opengl["fault"].is_null(), !opengl["devices"].empty()) << opengl;
  EXPECT_EQ(json["renderers"], Json({"cpu", "reference"}));
  expect_has(succeed(penumbra({"doctor"}, no_egl_driver)).out, {"cannot be used", "install"});
}

using RendererTest = TinyTest;

TEST_F(RendererTest, TheCpuIsTheDefault) {
  succeed(run({}, no_egl_driver));
  EXPECT_EQ(report()["renderer"]["backend"], "cpu");
  const Outcome outcome = succeed(render({"--json"}, no_egl_driver));
  EXPECT_EQ(Json::parse(outcome.out)["renderer"], report()["renderer"]);
}

TEST_F(RendererTest, OpenGlByNameIsNeverReplaced) {
  expect_refused(run({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(out("report.json")));
  expect_refused(render({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(path("vdi.npy")));
}

TEST_F(RendererTest, OpenGlIsNamedInTheReport) {
  const auto device = working_device();
  if (!device) GTEST_SKIP() << "no OpenGL device works here";
  succeed(run({"--renderer", "gl", "--gl-device", std::to_string(*device)}));
  const Json json = report();
  expect_values(json, {{"/renderer/backend", "gl"},
                       {"/renderer/isa", nullptr},
                       {"/renderer/threads", nullptr},
                       {"/frames/0/pixels/front", 64}});  // the object of 8 x 8 pixels
  const std::string words = json["renderer"]["device"];
  EXPECT_TRUE(words.starts_with(gl_devices()[*device].name)) << words;
}

}  // namespace
}  // namespace penumbra::test
