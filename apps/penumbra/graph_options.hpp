// SPDX-License-Identifier: Apache-2.0
// Options of the commands that take part in ROS 2's graph.
#pragma once

#include <apps/penumbra/options.hpp>
#include <io/dds/participant.hpp>

namespace penumbra::app {

inline constexpr double longest_wait = 3600.0;  // s

inline void add_domain(CLI::App& app, io::ParticipantOptions& graph) {
  constexpr int last_domain = 232;
  add_number(app, "--domain", "DDS's domain; default: ROS_DOMAIN_ID, else 0", "N", graph.domain, 0,
             last_domain);
}

}  // namespace penumbra::app
