// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/live_cameras.hpp>

namespace penumbra::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// The graph must not change for this long before the camera is chosen, or refused as ambiguous.
constexpr auto settled_after = 1s, ambiguous_after = 3s;

/// Returns the topics that programs other than Penumbra publish.
std::vector<io::BagTopic> published_topics(const io::Participant& graph) {
  std::vector<io::BagTopic> topics;
  for (const io::GraphTopic& topic : graph.graph())
    if (!topic.publishers.empty() && topic.name.find("/penumbra/") == std::string::npos)
      topics.push_back({.name = topic.name,
                        .type = topic.type,
                        .definition = {},
                        .encoding = "cdr",
                        .messages = {}});
  return topics;
}

std::string names_of(const std::vector<io::BagTopic>& topics) {
  std::string names;
  for (const io::BagTopic& topic : topics) names += topic.name + " " + topic.type + "\n";
  return names;
}

std::optional<std::string> resolved(const io::NameResolver& names,
                                    const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  return names.resolve(*name);
}

}  // namespace

io::CameraInputOptions camera_options(const LiveArguments& arguments) {
  const io::BagOptions& topics = arguments.session.input.bag;
  io::CameraInputOptions options;
  options.mount = io::mount_options(topics);
  options.info_is_named = topics.camera_info_topic.has_value();
  options.is_rectified = topics.rectified;
  options.depth_scale = topics.depth_scale;
  options.depth_along_ray = topics.depth_along_ray;
  options.poses = topics.poses.value_or(PoseSource::joints);
  options.time_offset = topics.time_offset;
  options.max_frames = static_cast<std::size_t>(arguments.queue);
  return options;
}

std::vector<io::CameraInputOptions> named_cameras(const LiveArguments& arguments,
                                                  const io::NameResolver& names,
                                                  const io::CameraInputOptions& common) {
  const io::BagOptions& topics = arguments.session.input.bag;
  auto named = arguments.cameras;
  if (topics.depth_topic) named.push_back({"", *topics.depth_topic});
  std::vector<io::CameraInputOptions> cameras;
  for (const auto& [name, topic] : named) {
    io::CameraInputOptions camera = common;
    camera.name = name;
    camera.depth_topic = names.resolve(topic);
    camera.info_topic = resolved(names, topics.camera_info_topic)
                            .value_or(io::camera_info_topic(camera.depth_topic));
    if (topics.color_topic) {
      camera.color_topic = names.resolve(*topics.color_topic);
      camera.color_info_topic = io::camera_info_topic(camera.color_topic);
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

std::vector<io::CloudInputOptions> named_clouds(const LiveArguments& arguments,
                                                const io::NameResolver& names) {
  const io::CameraInputOptions common = camera_options(arguments);
  std::vector<io::CloudInputOptions> clouds = arguments.clouds;
  for (io::CloudInputOptions& cloud : clouds) {
    cloud.topic = names.resolve(cloud.topic);
    cloud.mount = common.mount;
    cloud.poses = common.poses;
    cloud.max_frames = common.max_frames;
    cloud.has_targets = !arguments.session.input.bag.target_topics.empty();
  }
  return clouds;
}

io::BagOptions searched_topics(const LiveArguments& arguments, const io::NameResolver& names) {
  io::BagOptions topics = arguments.session.input.bag;
  for (auto* const name : {&topics.depth_topic, &topics.camera_info_topic, &topics.color_topic})
    *name = resolved(names, *name);
  return topics;
}

CameraSearch::CameraSearch(const io::Participant& graph, io::BagOptions topics)
    : graph_(graph), topics_(std::move(topics)), since_(Clock::now()) {}

std::optional<io::BagTopics> CameraSearch::find() {
  const auto topics = published_topics(graph_);
  if (std::string now = names_of(topics); now != seen_) {
    seen_ = std::move(now);
    since_ = Clock::now();
  }
  const auto settled = Clock::now() - since_;
  why_ = "nobody publishes depth images yet (discovery range " + io::discovery_range() + ")";
  try {
    const io::BagTopics chosen = io::choose_camera_topics("ROS 2's graph", topics, topics_, true);
    if (settled >= settled_after) return chosen;
    why_ = "waiting for what else is published";
  } catch (const io::AmbiguousTopics& error) {
    if (settled >= ambiguous_after) throw;
    why_ = error.what();
  } catch (const InputError& error) {
    if (!topics.empty()) why_ = error.what();
  }
  return std::nullopt;
}

io::CameraInputOptions found_camera(const io::BagTopics& chosen, io::CameraInputOptions common) {
  common.has_depth = chosen.has_depth;
  common.depth_topic = chosen.depth.name;
  common.info_topic = chosen.camera_info.name;
  if (chosen.color) common.color_topic = chosen.color->name;
  if (chosen.color_info) common.color_info_topic = chosen.color_info->name;
  return common;
}

}  // namespace penumbra::app
