// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string>
#include <vector>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/machine.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

std::string or_unknown(const std::string& text) { return text.empty() ? "not told" : text; }

void print_build(const io::BuildReport& build) {
  std::cout << "penumbra " << build.version << '\n'
            << "  build    " << or_unknown(build.type) << ", " << build.compiler << ", OpenGL "
            << (build.opengl ? "on" : "off") << ", DDS " << (build.dds ? "on" : "off");
  if (!build.sanitizers.empty()) std::cout << ", sanitizers " << build.sanitizers;
  std::cout << '\n';
}

void print_cpu(const io::MachineReport& machine) {
  std::cout << "\nCPU\n  model    " << or_unknown(machine.cpu_model) << "\n  threads  "
            << (machine.threads == 0 ? or_unknown("") : std::to_string(machine.threads))
            << "\n  SIMD     ";
  for (std::size_t i = 0; i < machine.simd.size(); ++i)
    std::cout << (i == 0 ? "" : ", ") << machine.simd[i] << (i == 0 ? " (used)" : "");
  std::cout << '\n';
}

void print_opengl(const io::MachineReport& machine) {
  std::cout << "\nOpenGL through EGL, without a display\n";
  if (!machine.gl_fault.empty()) {
    std::cout << "  cannot be used: " << machine.gl_fault << '\n';
    return;
  }
  std::vector<std::vector<std::string>> rows = {{"  DEVICE", "DRAWS IN", "NAME", "VERSION"}};
  for (std::size_t i = 0; i < machine.gl_devices.size(); ++i) {
    const GlDevice& device = machine.gl_devices[i];
    const std::string number = "  " + std::to_string(i);
    if (!device.fault.empty())
      rows.push_back({number, "-", or_unknown(device.name), "cannot be used: " + device.fault});
    else
      rows.push_back(
          {number, device.software ? "software" : "hardware", device.name, device.version});
  }
  print_table(rows);
}

void print_renderers(const std::vector<Backend>& renderers) {
  std::cout << "\nRenderers on this machine (--renderer)\n";
  for (const Backend renderer : renderers)
    std::cout << "  " << to_string(renderer) << (renderer == Backend::cpu ? " (default)" : "")
              << '\n';
}

void print_network(const io::MachineReport& machine) {
  std::cout << "\nLive topics of ROS 2\n";
  if (!machine.build.dds)
    std::cout << "  not built in: install cyclonedds-dev and build Penumbra again with "
                 "-DPENUMBRA_WITH_DDS=ON\n";
  std::cout << "  a socket may hold "
            << (machine.receive_buffer_limit
                    ? std::to_string(*machine.receive_buffer_limit / 1024) + " KiB"
                    : or_unknown(""))
            << " for its reader (net.core.rmem_max)\n";
  if (!machine.receive_buffer_advice.empty())
    std::cout << "  note: " << machine.receive_buffer_advice << '\n';
}

void print_libraries(const std::vector<io::LibraryVersion>& libraries) {
  std::cout << '\n';
  std::vector<std::vector<std::string>> rows = {{"LIBRARY", "BUILT WITH", "LOADED FROM"}};
  for (const io::LibraryVersion& library : libraries)
    rows.push_back({library.name, library.version.empty() ? "not built in" : library.version,
                    library.file.empty() ? "-" : library.file});
  print_table(rows);
}

}  // namespace

int execute(const DoctorArguments& arguments) {
  const io::MachineReport machine = examine_machine();
  if (arguments.json) {
    std::cout << io::machine_json(machine) << '\n';
    return 0;
  }
  print_build(machine.build);
  print_cpu(machine);
  print_opengl(machine);
  print_renderers(machine.renderers);
  print_network(machine);
  print_libraries(machine.build.libraries);
  return 0;
}

}  // namespace penumbra::app
