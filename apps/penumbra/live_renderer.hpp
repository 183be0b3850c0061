// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include <apps/penumbra/arguments.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::app {

/// Draws a small box by the renderer that is asked for: a device that is not there would be a fault
/// of every image to come. Throws InputError where it cannot.
void check_draws(const RendererArguments& renderer);

/// What stderr gets to know of the cameras' renderers, each thing once.
class RendererNews {
 public:
  /// What is new since the last call, a line each: what auto took for a camera and why, warnings.
  [[nodiscard]] std::vector<std::string> look(const io::LiveInbox& inbox);

 private:
  std::set<std::string> told_;
};

}  // namespace penumbra::app
