// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <apps/penumbra/receive_buffers.hpp>

namespace penumbra::app {
namespace {

// Two simultaneous images of 1280x720, depth and colour, are 4.4 MiB in 70 datagrams. Measured at
// 30 Hz: half of the colour images are lost with 1 MiB, none with 4 MiB (docs/live.md).
constexpr std::uint64_t enough = std::uint64_t{4} << 20;

std::optional<std::uint64_t> read_setting(const char* name) {
  std::ifstream file(std::string("/proc/sys/net/core/") + name);
  std::uint64_t bytes = 0;
  if (!(file >> bytes)) return std::nullopt;
  return bytes;
}

std::string in_kib(std::uint64_t bytes) { return std::to_string(bytes / 1024) + " KiB"; }

}  // namespace

ReceiveBuffers receive_buffers() {
  return {.limit = read_setting("rmem_max"), .normal = read_setting("rmem_default")};
}

std::string limit_advice(const ReceiveBuffers& buffers) {
  if (!buffers.limit || *buffers.limit >= enough) return {};
  return "the kernel limits the receive buffer to " + in_kib(*buffers.limit) +
         ", and large images are lost: sudo sysctl -w "
         "net.core.rmem_max=16777216 (and in /etc/sysctl.d to keep it)";
}

std::string normal_advice(const ReceiveBuffers& buffers) {
  if (!buffers.normal || *buffers.normal >= enough) return {};
  return "nodes on Fast DDS, ROS 2's default, receive with " + in_kib(*buffers.normal) +
         " and lose results when several large ones come at once: sudo sysctl -w "
         "net.core.rmem_default=4194304 where they run, or a profile with receive_buffer_size";
}

}  // namespace penumbra::app
