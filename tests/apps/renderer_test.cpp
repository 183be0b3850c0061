// SPDX-License-Identifier: Apache-2.0
// --renderer and --gl-device: what is taken, what the report says of it, what is refused.
#include "../support/opengl.hpp"
#include "json.hpp"
#include "program.hpp"
#include "tiny_recording.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

class RendererTest : public testing::Test {
 protected:
  RendererTest() { write_tiny_recording(folder_.path()); }

  Outcome run(std::vector<std::string> options, const std::vector<std::string>& environment = {}) {
    options.insert(options.begin(), {"run", folder_.path(), "-o", folder_.path() / "out"});
    return penumbra(options, environment);
  }
  Outcome render(std::vector<std::string> options,
                 const std::vector<std::string>& environment = {}) {
    options.insert(options.begin(),
                   {"render", "--robot", folder_.path() / "tiny.urdf", "--camera",
                    folder_.path() / "camera_info.yaml", "--pose",
                    folder_.path() / "camera_pose.csv", "-o", folder_.path() / "vdi.npy"});
    return penumbra(options, environment);
  }
  [[nodiscard]] Json report() const {
    return Json::parse(read_file(folder_.path() / "out" / "report.json"));
  }
  static void expect_refused(const Outcome& outcome, const std::string& word) {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
  }

  TemporaryFolder folder_;
};

TEST_F(RendererTest, TheCpuIsTheDefault) {
  ASSERT_EQ(run({}, no_egl_driver).status, 0);
  EXPECT_EQ(report()["renderer"]["backend"], "cpu");
  const Outcome outcome = render({"--json"}, no_egl_driver);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["renderer"], report()["renderer"]);
}

TEST_F(RendererTest, AutoIsUnknownAndTheChoicesAreNamed) {
  expect_refused(run({"--renderer", "auto"}), "cpu, gl, reference");
  expect_refused(render({"--renderer", "auto"}), "cpu, gl, reference");
}

TEST_F(RendererTest, OpenGlByNameIsNeverReplaced) {
  expect_refused(run({"--renderer", "gl"}, no_egl_driver), "renderer 'gl'");
  EXPECT_FALSE(fs::exists(folder_.path() / "out" / "report.json"));
  expect_refused(render({"--renderer", "gl"}, no_egl_driver), "renderer 'gl'");
  EXPECT_FALSE(fs::exists(folder_.path() / "vdi.npy"));
}

TEST_F(RendererTest, ADeviceThatIsNotThereIsRefused) {
  if (!working_device()) GTEST_SKIP() << "no OpenGL device works here";
  expect_refused(run({"--renderer", "gl", "--gl-device", "99"}), "99");
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
