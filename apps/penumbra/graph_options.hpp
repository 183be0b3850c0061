// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include <apps/penumbra/arguments.hpp>

namespace penumbra::app {

// Options of the commands that take part in ROS 2's graph.

void add_domain(CLI::App& app, io::ParticipantOptions& graph);

/// --remap FROM:=TO, from full name to full name, each once.
void add_remaps(CLI::App& app, std::map<std::string, std::string>& remaps);

/// A number of seconds from 0 to `most`.
[[nodiscard]] double to_seconds(const std::string& option, const std::string& text, double most);

void add_topics(CLI::App& app, TopicsArguments& topics);
void add_play(CLI::App& app, PlayArguments& play);
void add_live(CLI::App& app, LiveArguments& live);

/// Refuses what does not go together.
void check_live(const CLI::App& app, const LiveArguments& live);

}  // namespace penumbra::app
