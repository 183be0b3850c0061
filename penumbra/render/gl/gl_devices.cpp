// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_devices.hpp>
#include <penumbra/render/gl/open_device.hpp>

namespace penumbra {

std::vector<GlDevice> gl_devices() {
  std::vector<GlDevice> devices(gl::EglContext::device_count());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    try {
      devices[i] = gl::EglContext(i).device();
    } catch (const InputError& error) {
      devices[i].fault = error.what();
    }
  }
  return devices;
}

namespace gl {
namespace {

std::unique_ptr<EglContext> first_usable() {
  std::unique_ptr<EglContext> software;
  std::string first_fault;
  const std::size_t count = EglContext::device_count();
  for (std::size_t i = 0; i < count; ++i) {
    try {
      auto context = std::make_unique<EglContext>(i);
      if (!context->device().software) return context;
      if (!software) software = std::move(context);
    } catch (const InputError& error) {
      if (first_fault.empty()) first_fault = error.what();
    }
  }
  if (!software) throw InputError(first_fault);
  return software;
}

}  // namespace

std::unique_ptr<EglContext> open_device(int device) {
  if (device == -1) return first_usable();
  if (device < -1) {
    throw InputError("renderer 'gl': device " + std::to_string(device) +
                     " must be 0 or more, or -1 for the first that can be used");
  }
  return std::make_unique<EglContext>(static_cast<std::size_t>(device));
}

std::string words_of(const GlDevice& device) { return device.name + ", OpenGL " + device.version; }

void refuse_for_memory(const Intrinsics& intrinsics, std::span<const Body> bodies) {
  std::size_t triangles = 0;
  for (const Body& body : bodies) triangles += body.triangle_count();
  throw InputError("renderer 'gl': a robot of " + std::to_string(triangles) +
                   " triangles and an image of " + std::to_string(intrinsics.width()) + " x " +
                   std::to_string(intrinsics.height()) +
                   " pixels need more memory than this machine gives; use coarser meshes or a "
                   "smaller image");
}

}  // namespace gl
}  // namespace penumbra
