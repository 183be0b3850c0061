// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/robot/primitives.hpp>

#include <apps/penumbra/build_info.hpp>
#include <apps/penumbra/machine.hpp>
#include <io/dds/participant.hpp>
#include <io/dds/receive_buffers.hpp>

namespace penumbra::app {
namespace {

/// What stands after the colon of the first line of /proc/cpuinfo that begins with `key`.
std::string cpuinfo(std::string_view key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t value = line.find_first_not_of(": \t", line.find(':'));
    return value == std::string::npos ? "" : line.substr(value);
  }
  return {};
}

/// ARM's cpuinfo names no model; boards have one in the device tree.
std::string cpu_model() {
  std::string model = cpuinfo("model name");
  if (model.empty()) {
    std::ifstream board("/proc/device-tree/model");
    std::getline(board, model, '\0');
  }
  return model;
}

/// Files that this process has mapped, in their real names.
std::vector<std::string> loaded_files() {
  std::vector<std::string> files;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::size_t path = line.find('/');
    if (path == std::string::npos) continue;
    if (files.empty() || files.back() != line.substr(path)) files.push_back(line.substr(path));
  }
  return files;
}

std::vector<io::LibraryVersion> libraries() {
  const std::vector<std::string> loaded = loaded_files();
  std::vector<io::LibraryVersion> all;
  for (const BuildLibrary& library : build_libraries) {
    std::string file;
    for (const std::string& candidate : loaded)
      if (!library.file.empty() &&
          std::filesystem::path(candidate).filename().string().starts_with(library.file))
        file = candidate;
    all.push_back({std::string(library.name), std::string(library.version), file});
  }
  return all;
}

std::vector<GlDevice> devices_or_fault(std::string& fault) {
  try {
    return gl_devices();
  } catch (const InputError& error) {
    fault = error.what();
    return {};
  }
}

/// An arm of capsules and spheres, as large as a small robot's.
std::vector<TriangleMesh> small_arm() {
  return {make_cylinder(0.09, 0.12), make_sphere(0.08),         make_capsule(0.06, 0.4),
          make_sphere(0.07),         make_capsule(0.05, 0.35),  make_sphere(0.05),
          make_capsule(0.04, 0.1),   make_box({0.1, 0.1, 0.05})};
}

RendererChoice choose_for_small_arm() {
  const std::vector<TriangleMesh> arm = small_arm();
  std::vector<Body> bodies;
  bodies.reserve(arm.size());
  for (const TriangleMesh& mesh : arm) bodies.push_back({"link", {&mesh, 1}});
  return choose_backend(Intrinsics(640, 480, 600, 600, 319.5, 239.5), bodies);
}

}  // namespace

io::MachineReport examine_machine() {
  io::MachineReport machine;
  machine.cpu_model = cpu_model();
  machine.threads = std::thread::hardware_concurrency();
  machine.simd = simd_target_names();
  machine.gl_devices = devices_or_fault(machine.gl_fault);
  machine.choice = choose_for_small_arm();
  machine.receive_buffer_limit = io::receive_buffer_limit();
  machine.receive_buffer_advice = io::receive_buffer_advice(machine.receive_buffer_limit);
  machine.build = {PENUMBRA_VERSION,
                   std::string(build_type),
                   std::string(build_compiler),
                   std::string(build_sanitizers),
                   build_opengl,
                   io::has_dds(),
                   libraries()};
  return machine;
}

}  // namespace penumbra::app
