// SPDX-License-Identifier: Apache-2.0
// penumbra_research: the paper's experiments.
#include <cstdlib>
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>

#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>
#include <research/experiment.hpp>

namespace penumbra::research {
namespace {

constexpr double longest_run = 600.0;  // seconds

constexpr const char* examples = R"(
OUT gets metrics.json; scripts/experiment_tables.py makes tables of it. With --frames OUT also gets
frames/000000.png of the first seed. The same seeds give the same results on any number of threads.

Examples:
  penumbra_research conveyor -o out
  penumbra_research handover --seeds 0:2 -o out)";

void to_seeds(const std::string& text, ExperimentOptions& options) {
  const auto parts = app::split(text, ':');
  const auto first = io::parse_number<std::uint64_t>(parts.front());
  const auto end = io::parse_number<std::uint64_t>(parts.back());
  if (parts.size() != 2 || !first || !end || *first >= *end)
    app::refuse_option("--seeds", text, "A:B, the seeds from A up to but without B");
  options.first_seed = *first;
  options.end_seed = *end;
}

void add_options(CLI::App& cli, ExperimentOptions& options) {
  cli.footer(examples);
  cli.set_version_flag("--version", std::string("penumbra_research ") + PENUMBRA_VERSION);
  cli.add_option("NAME", options.experiment, "conveyor or handover")->required();
  app::add_text(cli, "-o,--output", "folder for the results; made if it is not there", "OUT",
                options.output)
      ->required();
  app::add_option(cli, "--seeds", "seeds from A up to but without B; default 0:30", "A:B",
                  [&](const std::string& text) { to_seeds(text, options); });
  app::add_number(cli, "--threads", "seeds that run at the same time; default: one per core", "N",
                  options.threads, 1, RendererOptions::max_threads);
  app::add_number(cli, "--duration", "seconds of each run; default: the scene's own", "S",
                  options.duration, 1e-3, longest_run);
  cli.add_flag("--frames", options.frames, "write the first seed's frames with boxes");
}

int run(int argc, char** argv) {
  ExperimentOptions options;
  CLI::App cli{"Compares methods in simulation, as the paper does.", "penumbra_research"};
  add_options(cli, options);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    return cli.exit(answered);
  } catch (const CLI::Error& error) {
    throw InputError(std::string(error.what()) + " (penumbra_research --help lists the options)");
  }
  std::optional<app::Progress> progress;
  run_experiment(options, [&](std::size_t total) {
    if (!progress) progress.emplace(total);
    progress->step();
  });
  progress.reset();
  std::cout << (options.output / "metrics.json").string() << '\n';
  return 0;
}

}  // namespace
}  // namespace penumbra::research

int main(int argc, char** argv) {
  setenv("EGL_LOG_LEVEL", "fatal", 0);  // Mesa's messages
  try {
    return penumbra::research::run(argc, argv);
  } catch (const penumbra::InputError& error) {
    std::cerr << "penumbra_research: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "penumbra_research: " << error.what() << '\n';
    return 1;
  }
}
