// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include <malloc.h>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

constexpr int our_fault = 1;
constexpr int users_fault = 2;

int fail(int status, const std::string& message) {
  print_error(message);
  return status;
}

}  // namespace

int run_program(int argc, char** argv) {
  // Memory of images is kept for the next frame's: to get it anew costs more than to fill it.
  constexpr int largest_image = 32 << 20, kept = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, largest_image);
  mallopt(M_TRIM_THRESHOLD, kept);
  // Errors are one line: Mesa adds none of its own, unless the user chooses a level.
  setenv("EGL_LOG_LEVEL", "fatal", 0);
  try {
    const auto command = parse_arguments(argc, argv);
    if (!command) return 0;
    const int status =
        std::visit([](const auto& arguments) { return execute(arguments); }, *command);
    if (!std::cout.flush()) return fail(users_fault, "standard output: cannot be written");
    return status;
  } catch (const InputError& error) {
    return fail(users_fault, error.what());
  } catch (const DeviceError& error) {
    return fail(our_fault, io::without_device(error));
  } catch (const std::bad_alloc&) {
    return fail(our_fault, "out of memory");
  } catch (const std::exception& error) {
    return fail(our_fault, std::string("internal error: ") + error.what());
  }
}

}  // namespace penumbra::app
