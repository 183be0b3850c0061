// SPDX-License-Identifier: Apache-2.0
// Replaces the command simulate in builds without the simulation.
#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {

void add_simulate(CLI::App& app, SimulateArguments& /*simulate*/) { app.allow_extras(); }

int execute(const SimulateArguments& /*arguments*/) {
  throw InputError(
      "this build has no simulation; install libmujoco-dev and libepoxy-dev and build with "
      "-DPENUMBRA_WITH_SIMULATION=ON");
}

}  // namespace penumbra::app
