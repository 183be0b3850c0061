// SPDX-License-Identifier: Apache-2.0
// Assimp 5.2.5 does not free its own reader where it refuses a glTF file. Nothing else is let pass.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)

const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libassimp\n";
}
