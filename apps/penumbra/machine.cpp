// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>

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

std::vector<Backend> renderers_of(const std::vector<GlDevice>& devices) {
  std::vector<Backend> renderers = {Backend::cpu};
  if (std::any_of(devices.begin(), devices.end(),
                  [](const GlDevice& device) { return device.fault.empty(); }))
    renderers.push_back(Backend::gl);
  renderers.push_back(Backend::reference);
  return renderers;
}

}  // namespace

io::MachineReport examine_machine() {
  io::MachineReport machine;
  machine.cpu_model = cpu_model();
  machine.threads = std::thread::hardware_concurrency();
  machine.simd = simd_target_names();
  machine.gl_devices = devices_or_fault(machine.gl_fault);
  machine.renderers = renderers_of(machine.gl_devices);
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
