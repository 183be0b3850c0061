// SPDX-License-Identifier: Apache-2.0
// Replaces the commands of ROS 2's graph in builds without DDS.
#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

[[noreturn]] void refuse() {
  throw InputError(
      "this build has no DDS, and so no ROS 2 graph: install cyclonedds-dev and nettle-dev and "
      "build Penumbra again with -DPENUMBRA_WITH_DDS=ON");
}

}  // namespace

void add_topics(CLI::App& app, TopicsArguments& /*topics*/) { app.allow_extras(); }
void add_play(CLI::App& app, PlayArguments& /*play*/) { app.allow_extras(); }
void add_live(CLI::App& app, LiveArguments& /*live*/) { app.allow_extras(); }
void check_live(const CLI::App& /*app*/, const LiveArguments& /*live*/) {}

int execute(const TopicsArguments& /*arguments*/) { refuse(); }
int execute(const PlayArguments& /*arguments*/) { refuse(); }
int execute(const LiveArguments& /*arguments*/) { refuse(); }

}  // namespace penumbra::app
