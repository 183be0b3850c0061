// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <optional>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/progress.hpp>
#include <sim/experiments/experiment.hpp>

namespace penumbra::app {

int execute(const ExperimentArguments& arguments) {
  std::optional<Progress> progress;
  sim::run_experiment(
      arguments, [&](std::size_t total) { progress.emplace(total); }, [&] { progress->step(); });
  progress.reset();
  std::cout << (arguments.output / "report.html").string() << '\n';
  return 0;
}

}  // namespace penumbra::app
