// SPDX-License-Identifier: Apache-2.0
// Replaces the commands of ROS 2's graph in builds without DDS.
#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

Execute add(CLI::App& app) {
  return refuse_command(app,
                        "this build has no DDS, and so no ROS 2 graph: install cyclonedds-dev and "
                        "nettle-dev and build Penumbra again with -DPENUMBRA_WITH_DDS=ON");
}

}  // namespace

Execute add_topics(CLI::App& app) { return add(app); }
Execute add_play(CLI::App& app) { return add(app); }
Execute add_live(CLI::App& app) { return add(app); }

}  // namespace penumbra::app
