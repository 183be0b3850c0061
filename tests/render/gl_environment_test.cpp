// SPDX-License-Identifier: Apache-2.0
// Machines on which parts of OpenGL are missing, as a process of their own sees them.
#include "../support/temporary_folder.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

/// Prints what OpenGL offers, or why there is none, and draws a frame. The others run it, with
/// parts of OpenGL missing.
TEST(GlProbe, PrintsWhatThereIs) {
  try {
    for (const GlDevice& device : gl_devices())
      std::cout << "device: " << device.name << ", fault: " << device.fault << '\n';
  } catch (const InputError& error) {
    std::cout << "no devices: " << error.what() << '\n';
  }
  const Intrinsics camera(32, 24, 30.0, 30.0, 15.5, 11.5);
  Scene scene;
  scene.add(box({1.0F, 1.0F, 0.1F}), at(0, 0, 2.1));
  try {
    const auto renderer = make(opengl, camera, scene.bodies());
    std::cout << "drawn: " << renderer->render(scene.poses).depth(15, 11) << '\n';
  } catch (const InputError& error) {
    std::cout << "refused: " << error.what() << '\n';
  }
}

class GlEnvironment : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
  }

  /// What the probe prints in an environment without a display and with these settings.
  static std::string probe(const std::string& settings) {
    const std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " + settings + " '" +
                                std::filesystem::read_symlink("/proc/self/exe").string() +
                                "' --gtest_filter=GlProbe.* 2>/dev/null";
    FILE* const pipe = popen(command.c_str(), "r");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += char(c);
    EXPECT_EQ(pclose(pipe), 0) << command << '\n' << text;
    return text;
  }

  /// Expects both the list of devices and a renderer to be refused in these words.
  static void expect_refused(const std::string& settings, const std::string& words) {
    const std::string text = probe(settings);
    for (const char* who : {"no devices: ", "refused: "}) {
      const std::size_t start = text.find(who);
      ASSERT_NE(start, std::string::npos) << settings << '\n' << text;
      const std::string line = text.substr(start, text.find('\n', start) - start);
      EXPECT_TRUE(holds(line, words));
      EXPECT_TRUE(holds(line, "libegl-mesa0"));
    }
  }
};

TEST_F(GlEnvironment, DrawsWithoutADisplay) { EXPECT_TRUE(holds(probe(""), "drawn: 2\n")); }

TEST_F(GlEnvironment, WithoutEglOrADriver) {
  const TemporaryFolder broken;
  broken.write("libEGL.so.1", "no library");
  expect_refused("LD_LIBRARY_PATH=" + broken.path().string(), "libEGL.so.1 cannot be loaded");
  expect_refused("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent", "EGL offers no device");
}

TEST_F(GlEnvironment, OlderOpenGlIsRefused) {
  // Mesa's own switch; the vendors of GPUs have none.
  const std::string text = probe("MESA_GL_VERSION_OVERRIDE=3.3");
  if (text.find("Mesa") == std::string::npos) GTEST_SKIP() << "skipped: not Mesa";
  EXPECT_TRUE(holds(text, "refused: renderer 'gl': OpenGL 4.5 is needed"));
  EXPECT_TRUE(holds(text, "fault: renderer 'gl': OpenGL 4.5 is needed"));
}

}  // namespace
}  // namespace penumbra::test
