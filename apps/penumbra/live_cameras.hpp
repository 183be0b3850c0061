// SPDX-License-Identifier: Apache-2.0
// Which cameras `penumbra live` takes: those that are named, or the one that the graph shows.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <apps/penumbra/live_arguments.hpp>
#include <io/assembly/bag_topics.hpp>
#include <io/dds/participant.hpp>
#include <io/live/live_inbox.hpp>
#include <io/ros/name_resolver.hpp>

namespace penumbra::app {

/// Returns the options that all cameras share. Throws InputError for the file of the pose.
[[nodiscard]] io::CameraInputOptions camera_options(const LiveArguments& arguments);

/// Returns the cameras whose depth topics are given by name. The topics need not exist yet.
[[nodiscard]] std::vector<io::CameraInputOptions> named_cameras(
    const LiveArguments& arguments, const io::NameResolver& names,
    const io::CameraInputOptions& common);

/// Returns the sensors of clouds. The topics need not exist yet.
[[nodiscard]] std::vector<io::CloudInputOptions> named_clouds(const LiveArguments& arguments,
                                                              const io::NameResolver& names);

/// Returns the user's choices for the topics of a camera that is searched.
[[nodiscard]] io::BagOptions searched_topics(const LiveArguments& arguments,
                                             const io::NameResolver& names);

/// Searches the one camera of a graph. Its topics may appear one after the other.
class CameraSearch {
 public:
  CameraSearch(const io::Participant& graph, io::BagOptions topics);

  /// Returns the camera's topics when the graph no longer changes. Nothing: not yet; why() says
  /// what is missing. Throws io::AmbiguousTopics if there are several for some seconds.
  [[nodiscard]] std::optional<io::BagTopics> find();
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  const io::Participant& graph_;
  io::BagOptions topics_;
  std::string seen_, why_;
  std::chrono::steady_clock::time_point since_;  // the last change
};

[[nodiscard]] io::CameraInputOptions found_camera(const io::BagTopics& chosen,
                                                  io::CameraInputOptions common);

}  // namespace penumbra::app
