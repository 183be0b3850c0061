// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

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

std::unique_ptr<EglContext> first_usable(GlProfile profile) {
  std::unique_ptr<EglContext> software;
  std::string first_fault;
  const std::size_t count = EglContext::device_count();
  for (std::size_t i = 0; i < count; ++i) {
    try {
      auto context = std::make_unique<EglContext>(i, profile);
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

std::unique_ptr<EglContext> open_device(int device, GlProfile profile) {
  if (device == -1) return first_usable(profile);
  if (device < -1) {
    throw InputError("renderer 'gl': device " + std::to_string(device) +
                     " must be 0 or more, or -1 for the first that can be used");
  }
  return std::make_unique<EglContext>(static_cast<std::size_t>(device), profile);
}

}  // namespace gl
}  // namespace penumbra
