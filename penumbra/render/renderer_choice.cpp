// SPDX-License-Identifier: Apache-2.0
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_devices.hpp>
#include <penumbra/render/renderer_choice.hpp>
#include <penumbra/render/renderer_race-inl.hpp>

namespace penumbra {
namespace {

/// The cpu backend's choice, as OpenGL cannot be used.
RendererChoice without_gl(const std::string& why) {
  return {Backend::cpu, "OpenGL cannot be used", {"OpenGL cannot be used: " + why}};
}

RendererChoice without_hardware(const std::vector<GlDevice>& devices) {
  if (devices.empty()) return without_gl("EGL lists no device; install the GPU's driver");
  RendererChoice choice;
  std::string software;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const GlDevice& device = devices[i];
    if (!device.fault.empty())
      choice.warnings.push_back("OpenGL device " + std::to_string(i) +
                                " cannot be used: " + device.fault);
    else if (software.empty())
      software = device.name;
  }
  choice.reason = software.empty() ? "no OpenGL device can be used"
                                   : "OpenGL has no GPU here: " + software + " draws on the CPU";
  return choice;
}

/// The device to measure: the one that is named, else the first that works and is a GPU.
std::optional<int> candidate(const std::vector<GlDevice>& devices, int named) {
  const int count = static_cast<int>(devices.size());
  if (named < -1 || named >= count)
    throw InputError("renderer 'gl': there is no device " + std::to_string(named) +
                     "; EGL offers " + std::to_string(count) + ", counted from 0");
  if (named >= 0) return named;
  for (int i = 0; i < count; ++i) {
    const GlDevice& device = devices[static_cast<std::size_t>(i)];
    if (device.fault.empty() && !device.software) return i;
  }
  return std::nullopt;
}

}  // namespace

VirtualDepthView ChosenRenderer::render(std::span<const Eigen::Isometry3d> T_camera_body) {
  try {
    return renderer->render(T_camera_body);
  } catch (const DeviceError& error) {
    if (!spare) throw;
    choice.backend = spare->info().backend;
    choice.warnings.push_back(std::string(error.what()) + ": " +
                              std::string(to_string(choice.backend)) + " draws from now on");
  }
  renderer = std::move(spare);
  return renderer->render(T_camera_body);
}

ChosenRenderer make_fastest_renderer(const Intrinsics& intrinsics, std::span<const Body> bodies,
                                     const RendererOptions& options) {
  auto cpu = make_depth_renderer(Backend::cpu, intrinsics, bodies, options);
  std::vector<GlDevice> devices;
  try {
    devices = gl_devices();
  } catch (const std::runtime_error& error) {
    return {without_gl(error.what()), std::move(cpu)};
  }
  RendererOptions gl_options = options;
  const std::optional<int> device = candidate(devices, options.gl_device);
  if (!device) return {without_hardware(devices), std::move(cpu)};
  gl_options.gl_device = *device;
  try {
    auto gl = make_depth_renderer(Backend::gl, intrinsics, bodies, gl_options);
    RendererChoice choice = race(*cpu, *gl, bodies);
    const bool gl_wins = choice.backend == Backend::gl;
    if (!gl_wins) return {std::move(choice), std::move(cpu)};
    return {std::move(choice), std::move(gl), std::move(cpu)};
  } catch (const std::bad_alloc&) {
    return {without_gl("trying it takes more memory than this machine gives"), std::move(cpu)};
  } catch (const std::runtime_error& error) {
    return {without_gl(error.what()), std::move(cpu)};
  }
}

RendererChoice choose_backend(const Intrinsics& intrinsics, std::span<const Body> bodies,
                              const RendererOptions& options) {
  return make_fastest_renderer(intrinsics, bodies, options).choice;
}

}  // namespace penumbra
