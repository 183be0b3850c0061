// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Throws InputError for a robot without geometry, which would make every pixel look clear.
inline void check_is_drawn(const Robot& robot) {
  const auto has_geometry = [](const LinkReport& link) { return link.drawn || link.missing; };
  if (std::any_of(robot.report().begin(), robot.report().end(), has_geometry)) return;
  throw InputError("robot '" + robot.name() +
                   "': no link is rendered; it needs geometry of the chosen kind that "
                   "ignore_links and only_links do not remove");
}

}  // namespace penumbra
