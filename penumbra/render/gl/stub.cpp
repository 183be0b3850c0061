// SPDX-License-Identifier: Apache-2.0
// Stands for the OpenGL renderer where it was not built.
#include <penumbra/base/error.hpp>
#include <penumbra/render/backends-inl.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra {
namespace {

[[noreturn]] void refuse() {
  throw InputError(
      "renderer 'gl': this build has no OpenGL; install libepoxy-dev and build with "
      "-DPENUMBRA_WITH_OPENGL=ON, or choose the renderer 'cpu'");
}

}  // namespace

std::vector<GlDevice> gl_devices() { refuse(); }

std::unique_ptr<DepthRenderer> make_gl_renderer(const Intrinsics& /*intrinsics*/,
                                                std::span<const Body> /*bodies*/, int /*device*/) {
  refuse();
}

}  // namespace penumbra
