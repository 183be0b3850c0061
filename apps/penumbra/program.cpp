// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/names.hpp>
#include <io/inputs/input_session.hpp>

namespace penumbra::app {
namespace {

constexpr int our_fault = 1;
constexpr int users_fault = 2;

int fail(int status, const std::string& message) {
  print_error(message);
  return status;
}

/// Throws InputError if the first argument is neither an option nor a command.
void check_command(int argc, const char* const* argv, std::span<const Command> commands) {
  const std::string_view name = argc > 1 ? argv[1] : "-";
  std::vector<std::string_view> names;
  for (const Command& command : commands) names.push_back(command.name);
  if (name.starts_with('-') || std::ranges::find(names, name) != names.end()) return;
  throw InputError("no such command: '" + std::string(name) + "'" + io::near_names(name, names) +
                   " (penumbra --help lists the commands)");
}

/// Returns a hint at the help of the given command.
std::string help_hint(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  const std::string command = commands.empty() ? "" : commands.front()->get_name() + " ";
  return " (penumbra " + command + "--help lists the options)";
}

int run_command(int argc, const char* const* argv, std::span<const Command> commands,
                const char* examples) {
  check_command(argc, argv, commands);
  CLI::App app{about, "penumbra"};
  app.footer(examples);
  app.set_version_flag("--version", std::string("penumbra ") + PENUMBRA_VERSION);
  app.require_subcommand(0, 1);
  std::vector<Execute> executes;
  for (const Command& command : commands)
    executes.push_back(command.add(*app.add_subcommand(command.name, command.help)));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    return app.exit(answered, std::cout, std::cerr);
  } catch (const CLI::Error& error) {
    throw InputError(std::string(error.what()) + help_hint(app));
  }
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (app.got_subcommand(commands[i].name)) return executes[i]();
  throw InputError("a command is needed, as 'penumbra run' (penumbra --help lists them)");
}

}  // namespace

int run_program(int argc, const char* const* argv, std::span<const Command> commands,
                const char* examples) {
  // Memory of images is kept for the next frame's: to get it anew costs more than to fill it.
  constexpr int largest_image = 32 << 20, kept = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, largest_image);
  mallopt(M_TRIM_THRESHOLD, kept);
  // Errors are one line: Mesa adds none of its own, unless the user chooses a level.
  setenv("EGL_LOG_LEVEL", "fatal", 0);
  try {
    const int status = run_command(argc, argv, commands, examples);
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
