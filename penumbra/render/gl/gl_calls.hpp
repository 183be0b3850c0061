// SPDX-License-Identifier: Apache-2.0
// Calls of OpenGL in the current context, with their errors.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>

namespace penumbra::gl {

/// Returns one of OpenGL's own strings, GL_RENDERER for instance; empty if it has none.
[[nodiscard]] std::string text(unsigned name);

/// Returns the name of the oldest error that OpenGL remembers, and clears all; empty: no error.
[[nodiscard]] std::string take_error();

/// Throws DeviceError if the context was lost or remembers an error: its drawing is invalid then.
void check_frame();

/// Makes a buffer and returns its name. `data` may be null. `flags` as glNamedBufferStorage takes
/// them; with GL_MAP_PERSISTENT_BIT among them `mapped` is required and receives the address of the
/// mapped buffer. Throws InputError, in which `what` needs the memory, if the device does not give
/// as much.
unsigned make_buffer(std::size_t bytes, const void* data, unsigned flags, const std::string& what,
                     std::byte** mapped = nullptr);

/// Bytes: more than any device asks of where in a buffer something may start.
inline constexpr std::size_t buffer_alignment = 256;

[[nodiscard]] constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + buffer_alignment - 1) / buffer_alignment * buffer_alignment;
}

/// An offset into the bound buffer, as OpenGL takes it in place of an address.
[[nodiscard]] inline void* as_address(std::size_t bytes) {
  return reinterpret_cast<void*>(bytes);  // NOLINT(performance-no-int-to-ptr): OpenGL's own way
}

/// A shader of OpenGL's kind `kind`.
struct ShaderSource {
  unsigned kind;
  const char* text;
};

/// Makes a program and returns its name. Throws std::runtime_error, with the driver's words, if it
/// does not compile or link.
[[nodiscard]] unsigned make_program(std::initializer_list<ShaderSource> shaders);

}  // namespace penumbra::gl
