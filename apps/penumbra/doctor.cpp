// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

#include <apps/penumbra/build_info.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/receive_buffers.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/json.hpp>

namespace penumbra::app {
namespace {

struct DoctorArguments {
  bool json = false;
};

using io::Json;
using io::or_null;

/// Returns the CPU's name, or the board's: ARM's cpuinfo has no model name.
std::string cpu_model() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name")) {
      const std::size_t value = line.find_first_not_of(": \t", line.find(':'));
      return value == std::string::npos ? "" : line.substr(value);
    }
  std::ifstream board("/proc/device-tree/model");
  std::string model;
  std::getline(board, model, '\0');
  return model;
}

/// Returns the file of a library that this process has mapped; empty if there is none.
std::string loaded_file(std::string_view library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; !library.empty() && std::getline(maps, line);) {
    const std::size_t path = line.find('/');
    if (path == std::string::npos) continue;
    if (std::filesystem::path(line.substr(path)).filename().string().starts_with(library))
      return line.substr(path);
  }
  return {};
}

Json opengl_json() {
  Json devices = Json::array();
  Json fault;
  try {
    for (const GlDevice& device : gl_devices())
      devices.push_back({{"index", devices.size()},
                         {"name", or_null(device.name)},
                         {"version", or_null(device.version)},
                         {"vendor", or_null(device.vendor)},
                         {"software", device.fault.empty() ? Json(device.software) : Json()},
                         {"fault", or_null(device.fault)}});
  } catch (const InputError& error) {
    fault = error.what();
  }
  return {{"fault", fault}, {"devices", devices}};
}

Json renderers_json(const Json& devices) {
  Json renderers = {to_string(Backend::cpu)};
  for (const Json& device : devices)
    if (device["fault"].is_null() && renderers.size() == 1)
      renderers.push_back(to_string(Backend::gl));
  renderers.push_back(to_string(Backend::reference));
  return renderers;
}

Json libraries_json() {
  Json libraries = Json::array();
  for (const BuildLibrary& library : build_libraries)
    libraries.push_back({{"name", library.name},
                         {"version", or_null(std::string(library.version))},
                         {"file", or_null(loaded_file(library.file))}});
  return libraries;
}

/// What `doctor --json` prints. Values that do not apply are null.
Json examine_machine() {
  const unsigned threads = std::thread::hardware_concurrency();
  const ReceiveBuffers buffers = receive_buffers();
  Json advice = Json::array();
  for (const std::string& line : {limit_advice(buffers), normal_advice(buffers)})
    if (!line.empty()) advice.push_back(line);
  Json opengl = opengl_json();
  Json renderers = renderers_json(opengl["devices"]);
  return {{"penumbra", PENUMBRA_VERSION},
          {"build",
           {{"type", or_null(std::string(build_type))},
            {"compiler", build_compiler},
            {"sanitizers", or_null(std::string(build_sanitizers))},
            {"opengl", build_opengl},
            {"dds", build_dds}}},
          {"cpu",
           {{"model", or_null(cpu_model())},
            {"threads", threads == 0 ? Json() : Json(threads)},
            {"simd", simd_target_names()}}},
          {"opengl", std::move(opengl)},
          {"renderers", std::move(renderers)},
          {"network",
           {{"receive_buffer_limit", or_null(buffers.limit)},
            {"receive_buffer_default", or_null(buffers.normal)},
            {"advice", std::move(advice)}}},
          {"libraries", libraries_json()}};
}

std::string text_of(const Json& value, const std::string& if_null = "not known") {
  if (value.is_null()) return if_null;
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void print_opengl(const Json& opengl) {
  std::cout << "\nOpenGL through EGL, without a display\n";
  if (!opengl["fault"].is_null()) {
    std::cout << "  cannot be used: " << text_of(opengl["fault"]) << '\n';
    return;
  }
  std::vector<std::vector<std::string>> rows = {{"  DEVICE", "DRAWS IN", "NAME", "VERSION"}};
  for (const Json& device : opengl["devices"]) {
    const std::string number = "  " + text_of(device["index"]);
    if (!device["fault"].is_null())
      rows.push_back(
          {number, "-", text_of(device["name"]), "cannot be used: " + text_of(device["fault"])});
    else
      rows.push_back({number, device["software"] ? "software" : "hardware", text_of(device["name"]),
                      text_of(device["version"])});
  }
  print_table(rows);
}

void print_network(const Json& machine) {
  const Json& network = machine["network"];
  const auto kibibytes = [&](const char* key) {
    return network[key].is_null()
               ? "an unknown number of bytes"
               : std::to_string(network[key].get<std::uint64_t>() / 1024) + " KiB";
  };
  std::cout << "\nLive topics of ROS 2\n";
  if (!machine["build"]["dds"])
    std::cout
        << "  not built in: install cyclonedds-dev and nettle-dev and build Penumbra again with "
           "-DPENUMBRA_WITH_DDS=ON\n";
  std::cout << "  a socket may hold " << kibibytes("receive_buffer_limit")
            << " for its reader (net.core.rmem_max), by default "
            << kibibytes("receive_buffer_default") << " (net.core.rmem_default)\n";
  for (const Json& advice : network["advice"]) std::cout << "  note: " << text_of(advice) << '\n';
}

void print_machine(const Json& machine) {
  const Json &build = machine["build"], &cpu = machine["cpu"];
  std::cout << "penumbra " << text_of(machine["penumbra"]) << "\n  build    "
            << text_of(build["type"]) << ", " << text_of(build["compiler"]) << ", OpenGL "
            << (build["opengl"] ? "on" : "off") << ", DDS " << (build["dds"] ? "on" : "off");
  if (!build["sanitizers"].is_null()) std::cout << ", sanitizers " << text_of(build["sanitizers"]);
  std::cout << "\n\nCPU\n  model    " << text_of(cpu["model"]) << "\n  threads  "
            << text_of(cpu["threads"]) << "\n  SIMD     ";
  for (std::size_t i = 0; i < cpu["simd"].size(); ++i)
    std::cout << (i == 0 ? "" : ", ") << text_of(cpu["simd"][i]) << (i == 0 ? " (used)" : "");
  std::cout << '\n';
  print_opengl(machine["opengl"]);
  std::cout << "\nRenderers on this machine (--renderer)\n";
  for (const Json& renderer : machine["renderers"])
    std::cout << "  " << text_of(renderer) << (renderer == "cpu" ? " (default)" : "") << '\n';
  print_network(machine);
  std::cout << '\n';
  std::vector<std::vector<std::string>> rows = {{"LIBRARY", "BUILT WITH", "LOADED FROM"}};
  for (const Json& library : machine["libraries"])
    rows.push_back({text_of(library["name"]), text_of(library["version"], "not built in"),
                    text_of(library["file"], "-")});
  print_table(rows);
}

void add_options(CLI::App& app, DoctorArguments& doctor) {
  app.footer(doctor_examples);
  app.add_flag("--json", doctor.json, "print JSON instead of text");
}

int execute(const DoctorArguments& arguments) {
  const Json machine = examine_machine();
  if (arguments.json)
    std::cout << machine.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  else
    print_machine(machine);
  return 0;
}

}  // namespace

Execute add_doctor(CLI::App& app) {
  return make_command<DoctorArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
