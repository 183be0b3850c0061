// SPDX-License-Identifier: Apache-2.0
// Replaces the command simulate in builds without the simulation.
#include <apps/penumbra/options.hpp>

namespace penumbra::app {

Execute add_simulate(CLI::App& app) {
  return refuse_command(app,
                        "this build has no simulation; install libmujoco-dev and libepoxy-dev and "
                        "build with -DPENUMBRA_WITH_SIMULATION=ON");
}

}  // namespace penumbra::app
