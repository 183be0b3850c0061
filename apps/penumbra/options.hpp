// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include <apps/penumbra/argument_values.hpp>
#include <apps/penumbra/arguments.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::app {

/// Adds an option that may be given once and whose text `take` reads.
template <typename Take>
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::string& value, Take take) {
  return app.add_option_function<std::string>(names, take, help)->type_name(value)->expected(1);
}

/// The same for an option that may be given several times.
template <typename Take>
CLI::Option* add_list(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, Take take) {
  return app
      .add_option_function<std::vector<std::string>>(
          names,
          [take](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) take(text);
          },
          help)
      ->type_name(value)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

template <typename T>
void add_number(CLI::App& app, const std::string& names, const std::string& help,
                const std::string& unit, T& to) {
  const std::string wanted = std::is_floating_point_v<T> ? "a number" : "a whole number from 0";
  add_option(app, names, help, unit, [&to, names, wanted](const std::string& text) {
    const auto value = io::parse_number<T>(text);
    if (!value) refuse_option(names, text, wanted);
    to = *value;
  });
}

/// A path that is not empty.
CLI::Option* add_path(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, std::filesystem::path& to);

/// Options that several commands have.
void add_renderer(CLI::App& app, Backend& backend, RendererOptions& renderer);
void add_extra(CLI::App& app, std::vector<ExtraMesh>& extra);
void add_leniency(CLI::App& app, bool& allow_missing_meshes, bool& geometry_fallback);

/// --port and --address. `port_help`: what --port means.
void add_server(CLI::App& app, ServerArguments& server, const std::string& port_help);

/// What the help of a bag's options says.
struct BagHelp {
  std::string group = "Of bags";
  std::string joints = "/joint_states, or the only one";  ///< default of --joint-topic
  std::string poses = "joints, else tf";                  ///< default of --poses
};

/// How frames are judged: renderer, geometry, tolerance, labels.
void add_judging(CLI::App& app, io::JudgingOptions& judging,
                 const std::string& geometry_default = "the recording's, else collision");
/// Which topics are used, and what they leave open.
void add_bag(CLI::App& app, io::BagOptions& bag, const BagHelp& help = {});

/// Refuses options that the chosen renderer does not use.
void check_renderer(Backend backend, const RendererOptions& options);

// The commands with options of many kinds.
void add_run(CLI::App& app, RunArguments& run);
void add_tune(CLI::App& app, TuneArguments& tune);
void add_view(CLI::App& app, ViewArguments& view);
void add_simulate(CLI::App& app, SimulateArguments& simulate);

// Each refuses options of its command that exclude each other, and derives the rest from them.
void check_run(const CLI::App& app, RunArguments& run);
void check_tune(const CLI::App& app, TuneArguments& tune);
void check_view(const CLI::App& app, ViewArguments& view);

}  // namespace penumbra::app
