// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>

namespace CLI {
class App;
}

namespace penumbra::app {

// Exit statuses next to 0.
inline constexpr int device_failed = 1, nothing_judged = 2;

/// Runs a command whose options were read, and returns its exit status. Throws InputError where the
/// user's input is at fault.
using Execute = std::function<int()>;

/// A command: `add` adds its options.
struct Command {
  const char* name;
  const char* help;
  Execute (*add)(CLI::App& app);
};

/// Makes a command of a struct that holds its options' values. `check`, which may be null, refuses
/// options that exclude each other, and derives the rest from them.
template <typename Arguments>
Execute make_command(CLI::App& app, void (*add)(CLI::App&, Arguments&),
                     void (*check)(const CLI::App&, Arguments&), int (*execute)(const Arguments&)) {
  const auto arguments = std::make_shared<Arguments>();
  add(app, *arguments);
  return [=, &app] {
    if (check != nullptr) check(app, *arguments);
    return execute(*arguments);
  };
}

/// The program: reads the command line, and runs the command that it names. `examples`: what
/// --help prints last. Returns the exit status.
[[nodiscard]] int run_program(int argc, const char* const* argv, std::span<const Command> commands,
                              const char* examples);

[[nodiscard]] Execute add_calibrate(CLI::App& app);
[[nodiscard]] Execute add_cloud(CLI::App& app);
[[nodiscard]] Execute add_doctor(CLI::App& app);
[[nodiscard]] Execute add_init(CLI::App& app);
[[nodiscard]] Execute add_inspect(CLI::App& app);
[[nodiscard]] Execute add_live(CLI::App& app);
[[nodiscard]] Execute add_look_ahead(CLI::App& app);
[[nodiscard]] Execute add_play(CLI::App& app);
[[nodiscard]] Execute add_render(CLI::App& app);
[[nodiscard]] Execute add_run(CLI::App& app);
[[nodiscard]] Execute add_simulate(CLI::App& app);
[[nodiscard]] Execute add_topics(CLI::App& app);
[[nodiscard]] Execute add_tune(CLI::App& app);
[[nodiscard]] Execute add_view(CLI::App& app);
[[nodiscard]] Execute add_view_planning(CLI::App& app);

}  // namespace penumbra::app
