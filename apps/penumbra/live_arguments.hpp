// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/server_options.hpp>
#include <io/assembly/cloud_input.hpp>
#include <io/dds/participant.hpp>

namespace penumbra::app {

struct LiveArguments {
  io::SessionOptions session;  ///< renderer, what is drawn, the rule of labels, topics
  io::ParticipantOptions graph;
  std::vector<NamedCamera> cameras;  ///< empty and no clouds: one, found by type and name
  std::vector<io::CloudInputOptions> clouds;
  std::string name_space;
  std::vector<std::string> remaps;     ///< FROM:=TO
  bool reliable = false;               ///< asked of images, joint states and tf
  int queue = 8;                       ///< images that wait at a time, of each camera
  std::optional<std::string> publish;  ///< names of results; nothing: all
  PointsRule points;
  double points_rate = 0;          ///< see io::LiveOptions
  std::optional<double> duration;  ///< seconds
  std::optional<std::filesystem::path> summary;
  bool calibrate = false;
  bool search = false;     ///< calibrate without a first guess
  ServerArguments server;  ///< no page is served without a port
};

/// Runs until a signal, or for `duration`. Returns the exit status.
[[nodiscard]] int execute(const LiveArguments& arguments);

}  // namespace penumbra::app
