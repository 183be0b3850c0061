// SPDX-License-Identifier: Apache-2.0
// Which cameras `penumbra live` takes: those that are named, or the one that the graph shows.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <apps/penumbra/arguments.hpp>
#include <io/assembly/bag_topics.hpp>
#include <io/dds/participant.hpp>
#include <io/live/live_inbox.hpp>
#include <io/live/name_resolver.hpp>

namespace penumbra::app {

/// What does not depend on which camera it is. Throws InputError of the pose's file.
[[nodiscard]] io::CameraInputOptions camera_options(const LiveArguments& arguments);

/// Cameras whose depth images are named: nothing has to be there yet.
[[nodiscard]] std::vector<io::CameraInputOptions> named_cameras(
    const LiveArguments& arguments, const io::NameResolver& names,
    const io::CameraInputOptions& common);

/// Returns what the user says of the topics of a camera that is not named.
[[nodiscard]] io::BagOptions searched_topics(const LiveArguments& arguments,
                                             const io::NameResolver& names);

/// Looks for the one camera of a graph, which appears bit by bit.
class CameraSearch {
 public:
  CameraSearch(const io::Participant& graph, io::BagOptions topics);

  /// The camera's topics, once the graph has settled; nothing: not yet, why() says what lacks.
  /// Throws io::AmbiguousTopics where there are several, and it stays so.
  [[nodiscard]] std::optional<io::BagTopics> look();
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  const io::Participant& graph_;
  io::BagOptions topics_;
  std::string seen_, why_;
  std::chrono::steady_clock::time_point since_;  // it is as it is
};

[[nodiscard]] io::CameraInputOptions found_camera(const io::BagTopics& chosen,
                                                  io::CameraInputOptions common);

}  // namespace penumbra::app
