// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <optional>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/progress.hpp>
#include <io/pending_file.hpp>
#include <sim/experiments/experiment.hpp>

namespace penumbra::app {

int execute(const ExperimentArguments& arguments) {
  const std::filesystem::path report = arguments.output / "report.html";
  const auto run = [&] {
    std::optional<Progress> progress;
    sim::run_experiment(
        arguments, [&](std::size_t total) { progress.emplace(total); }, [&] { progress->step(); });
    progress.reset();
    std::cout << report.string() << '\n';
    return 0;
  };
  return io::run_or_say_state({arguments.output / "metrics.json", report}, run);
}

}  // namespace penumbra::app
