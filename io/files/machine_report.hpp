// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::io {

/// A library that Penumbra was built with.
struct LibraryVersion {
  std::string name;
  std::string version;  ///< of the build
  std::string file;     ///< what of it this process has loaded; empty: only headers, or not loaded
};

/// How this program was built.
struct BuildReport {
  std::string version;  ///< Penumbra's
  std::string type;     ///< CMAKE_BUILD_TYPE
  std::string compiler;
  std::string sanitizers;  ///< as in -fsanitize=; empty: none
  bool opengl = false;     ///< the gl renderer is in it
  bool dds = false;        ///< live topics of ROS 2 are in it
  std::vector<LibraryVersion> libraries;
};

/// What a machine offers.
struct MachineReport {
  BuildReport build;
  std::string cpu_model;          ///< empty: the system does not say
  unsigned threads = 0;           ///< hardware threads; 0: the system does not say
  std::vector<std::string> simd;  ///< targets by Highway's names, best first: it is the one used
  std::vector<GlDevice> gl_devices;
  std::string gl_fault;            ///< why there are no OpenGL devices, and what to install
  std::vector<Backend> renderers;  ///< that draw on this machine, the default first
  /// The most bytes that a socket may hold for its reader; nothing: the system does not say.
  std::optional<std::uint64_t> receive_buffer_limit;
  std::string receive_buffer_advice;  ///< where that is too little for images; empty: it is not
};

/// What `doctor --json` prints; what does not apply is null.
[[nodiscard]] std::string machine_json(const MachineReport& machine);

}  // namespace penumbra::io
