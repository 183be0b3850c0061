// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace penumbra::gl {

/// Makes a buffer of the current context and returns its name. `data` may be null. `flags` as
/// glNamedBufferStorage takes them; with GL_MAP_PERSISTENT_BIT among them `mapped` must be given
/// and receives where the buffer is mapped. Throws InputError, in which `what` needs the memory,
/// where the device does not take as much.
unsigned make_buffer(std::size_t bytes, const void* data, unsigned flags, const std::string& what,
                     std::byte** mapped = nullptr);

/// Bytes: more than any device asks of where in a buffer something may start.
inline constexpr std::size_t buffer_alignment = 256;

[[nodiscard]] constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + buffer_alignment - 1) / buffer_alignment * buffer_alignment;
}

/// Pixels from a row of an image in memory to the next: rows start on cache lines.
[[nodiscard]] constexpr std::size_t row_stride(int width) {
  constexpr std::size_t alignment = 64;
  return (static_cast<std::size_t>(width) + alignment - 1) / alignment * alignment;
}

/// An offset into the bound buffer, as OpenGL takes it in place of an address.
[[nodiscard]] inline void* as_address(std::size_t bytes) {
  return reinterpret_cast<void*>(bytes);  // NOLINT(performance-no-int-to-ptr): OpenGL's own way
}

}  // namespace penumbra::gl
