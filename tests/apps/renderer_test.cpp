// SPDX-License-Identifier: Apache-2.0
// --renderer and --gl-device: what is taken, what the report says of it, what is refused.
#include "../support/opengl.hpp"
#include "fixtures.hpp"

#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

class RendererTest : public TinyTest {
 protected:
  Outcome run(Words options, const Words& environment = {}) const {
    options.insert(options.begin(), {"run", path(), "-o", out()});
    return penumbra(options, environment);
  }
};

TEST_F(RendererTest, TheCpuIsTheDefault) {
  ASSERT_EQ(run({}, no_egl_driver).status, 0);
  EXPECT_EQ(report()["renderer"]["backend"], "cpu");
  const Outcome outcome = render({"--json"}, no_egl_driver);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["renderer"], report()["renderer"]);
}

TEST_F(RendererTest, OpenGlByNameIsNeverReplaced) {
  expect_refused(run({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(out() / "report.json"));
  expect_refused(render({"--renderer", "gl"}, no_egl_driver), {"renderer 'gl'"});
  EXPECT_FALSE(fs::exists(path("vdi.npy")));
}

TEST_F(RendererTest, OpenGlIsNamedInTheReport) {
  const auto device = working_device();
  if (!device) GTEST_SKIP() << "no OpenGL device works here";
  const Outcome outcome = run({"--renderer", "gl", "--gl-device", std::to_string(*device)});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json json = report();
  EXPECT_EQ(json["renderer"]["backend"], "gl");
  EXPECT_TRUE(json["renderer"]["isa"].is_null());
  EXPECT_TRUE(json["renderer"]["threads"].is_null());
  const std::string words = json["renderer"]["device"];
  EXPECT_TRUE(words.starts_with(gl_devices()[*device].name)) << words;
  EXPECT_EQ(json["frames"][0]["pixels"]["front"], 64) << "the object of 8 x 8 pixels";
}

}  // namespace
}  // namespace penumbra::test
