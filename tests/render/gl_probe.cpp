// SPDX-License-Identifier: Apache-2.0
// Prints what OpenGL offers in the environment that it was started in, or why there is none, and
// draws one frame: GlEnvironment runs it with parts of OpenGL missing.
#include "render_test.hpp"
#include "shapes.hpp"

#include <iostream>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

int main() {
  using namespace penumbra;
  try {
    for (const GlDevice& device : gl_devices())
      std::cout << "device: " << device.name << ", fault: " << device.fault << '\n';
  } catch (const InputError& error) {
    std::cout << "no devices: " << error.what() << '\n';
  }
  const Intrinsics camera(32, 24, 30.0, 30.0, 15.5, 11.5);
  test::Scene scene;
  scene.add(test::box({1.0F, 1.0F, 0.1F}), test::at(0, 0, 2.1));
  try {
    const auto renderer = test::make({Backend::gl, "", 1}, camera, scene.bodies());
    std::cout << "drawn: " << renderer->render(scene.poses).depth(15, 11) << '\n';
  } catch (const InputError& error) {
    std::cout << "refused: " << error.what() << '\n';
  }
  return 0;
}
