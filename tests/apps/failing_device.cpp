// SPDX-License-Identifier: Apache-2.0
// Loaded before a program's own libraries: its graphics device is reset when its state was asked
// for PENUMBRA_TEST_SPARED times.
#include <cstdlib>

#include <epoxy/gl.h>

namespace {

int spared = 0;

GLenum reset_status() { return spared-- > 0 ? GL_NO_ERROR : GL_UNKNOWN_CONTEXT_RESET; }

[[gnu::constructor]] void begin() {
  const char* const given = std::getenv("PENUMBRA_TEST_SPARED");
  if (given == nullptr) return;
  spared = std::atoi(given);
  epoxy_glGetGraphicsResetStatus = reset_status;
}

}  // namespace
