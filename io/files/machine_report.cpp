// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/files/json-inl.hpp>
#include <io/files/machine_report.hpp>

namespace penumbra::io {
namespace {

Json build_json(const BuildReport& build) {
  return {{"type", or_null(build.type)},
          {"compiler", build.compiler},
          {"sanitizers", or_null(build.sanitizers)},
          {"opengl", build.opengl},
          {"dds", build.dds}};
}

Json device_json(std::size_t index, const GlDevice& device) {
  return {{"index", index},
          {"name", or_null(device.name)},
          {"version", or_null(device.version)},
          {"vendor", or_null(device.vendor)},
          {"software", device.fault.empty() ? Json(device.software) : Json(nullptr)},
          {"fault", or_null(device.fault)}};
}

Json opengl_json(const MachineReport& machine) {
  Json devices = Json::array();
  for (std::size_t i = 0; i < machine.gl_devices.size(); ++i)
    devices.push_back(device_json(i, machine.gl_devices[i]));
  return {{"fault", or_null(machine.gl_fault)}, {"devices", std::move(devices)}};
}

Json renderers_json(const std::vector<Backend>& renderers) {
  Json names = Json::array();
  for (const Backend renderer : renderers) names.push_back(to_string(renderer));
  return names;
}

Json libraries_json(const std::vector<LibraryVersion>& libraries) {
  Json all = Json::array();
  for (const LibraryVersion& library : libraries)
    all.push_back({{"name", library.name},
                   {"version", or_null(library.version)},
                   {"file", or_null(library.file)}});
  return all;
}

}  // namespace

std::string machine_json(const MachineReport& machine) {
  const Json json = {{"penumbra", machine.build.version},
                     {"build", build_json(machine.build)},
                     {"cpu",
                      {{"model", or_null(machine.cpu_model)},
                       {"threads", machine.threads == 0 ? Json(nullptr) : Json(machine.threads)},
                       {"simd", machine.simd}}},
                     {"opengl", opengl_json(machine)},
                     {"renderers", renderers_json(machine.renderers)},
                     {"network",
                      {{"receive_buffer_limit", or_null(machine.receive_buffer_limit)},
                       {"advice", or_null(machine.receive_buffer_advice)}}},
                     {"libraries", libraries_json(machine.build.libraries)}};
  // A driver's words may hold bytes that are no UTF-8: those are replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
