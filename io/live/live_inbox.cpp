// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include <io/assembly/frame_tree.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {
namespace {

/// Stamps with a larger latency come from another clock: a simulation's, or one that is not set.
/// Nanoseconds.
constexpr std::int64_t longest_latency = 60'000'000'000;

std::string type_of_images(const std::string& topic) {
  return image_base(topic) == topic ? message_type<ImageMessage>()
                                    : message_type<CompressedImageMessage>();
}

void add_topics_of_robot(const LiveOptions& options, std::vector<LiveTopic>& topics) {
  if (!options.robot.given)
    topics.push_back({.role = LiveRole::description,
                      .name = options.description_topic,
                      .type = message_type<StringMessage>(),
                      .latched = true});
  if (options.poses != PoseSource::transforms)
    for (const std::string& name : options.joint_topics)
      topics.push_back(
          {.role = LiveRole::joints, .name = name, .type = message_type<JointStateMessage>()});
  topics.push_back({.role = LiveRole::transforms,
                    .name = options.transform_topic,
                    .type = message_type<TfMessage>()});
  topics.push_back({.role = LiveRole::static_transforms,
                    .name = options.static_transform_topic,
                    .type = message_type<TfMessage>(),
                    .latched = true});
  for (const std::string& name : options.target_topics)
    topics.push_back({.role = LiveRole::targets, .name = name});
}

void add_topics_of_camera(const LiveCameraOptions& options, std::size_t camera,
                          std::vector<LiveTopic>& topics) {
  const auto add = [&](LiveRole role, const std::string& name, const std::string& type) {
    if (!name.empty()) topics.push_back({role, camera, name, type});
  };
  add(LiveRole::camera_info, options.info_topic, message_type<CameraInfoMessage>());
  add(LiveRole::color_info, options.color_info_topic, message_type<CameraInfoMessage>());
  add(LiveRole::color, options.color_topic, type_of_images(options.color_topic));
  add(LiveRole::depth, options.depth_topic, type_of_images(options.depth_topic));
}

template <typename M>
constexpr bool is_of_pixels =
    std::is_same_v<M, Detection2DArrayMessage> || std::is_same_v<M, KeypointsMessage>;

}  // namespace

std::span<const std::string> LiveInbox::target_types() {
  static const std::array types = {
      message_type<Detection2DArrayMessage>(), message_type<Detection3DArrayMessage>(),
      message_type<KeypointsMessage>(), message_type<PoseStampedMessage>()};
  return types;
}

LiveInbox::LiveInbox(const LiveOptions& options)
    : options_(options), robot_(options.robot), tallies_(options.cameras.size()) {
  add_topics_of_robot(options_, topics_);
  for (std::size_t i = 0; i < options_.cameras.size(); ++i) {
    cameras_.push_back(std::make_unique<LiveCamera>(options_.cameras[i], robot_));
    add_topics_of_camera(options_.cameras[i], i, topics_);
  }
  received_.resize(topics_.size());
}

template <typename M>
bool LiveInbox::decode(std::size_t topic, const LiveMessage& message, std::int64_t now,
                       M& decoded) {
  static const Decoder<M> decoder;
  const auto fault = decoder.decode(message.data, decoded);
  if (fault) faults_.add(topics_[topic].name, now, *fault);
  return !fault;
}

void LiveInbox::receive(std::size_t topic, const LiveMessage& message, std::int64_t now) {
  ++received_[topic];
  const LiveTopic& from = topics_[topic];
  switch (from.role) {
    case LiveRole::depth:
    case LiveRole::color:
      return from.type == message_type<ImageMessage>()
                 ? receive_image<ImageMessage>(topic, message, now)
                 : receive_image<CompressedImageMessage>(topic, message, now);
    case LiveRole::camera_info:
    case LiveRole::color_info: {
      CameraInfoMessage info;
      if (!decode(topic, message, now, info)) return;
      if (from.role == LiveRole::camera_info) return cameras_[from.camera]->take_info(info, now);
      return cameras_[from.camera]->take_color_info(info);
    }
    case LiveRole::targets:
      return receive_targets(topic, message, now);
    default:
      return receive_of_robot(topic, message, now);
  }
}

void LiveInbox::receive_of_robot(std::size_t topic, const LiveMessage& message, std::int64_t now) {
  const LiveRole role = topics_[topic].role;
  if (role == LiveRole::joints) {
    if (JointStateMessage state; decode(topic, message, now, state))
      robot_.take(state, sources_.of_joints(topics_[topic].name, message.publisher, state), now);
    return;
  }
  if (role == LiveRole::description) {
    if (StringMessage text; decode(topic, message, now, text)) robot_.take(text);
  } else if (TfMessage found; decode(topic, message, now, found)) {
    robot_.take(found, role == LiveRole::static_transforms,
                sources_.of_transforms(topics_[topic].name, message.publisher), now);
  }
  for (const auto& camera : cameras_) camera->follow_robot();
}

void LiveInbox::place(MadeRobot made) {
  robot_.place(std::move(made));
  for (const auto& camera : cameras_) camera->follow_robot();
}

template <typename M>
void LiveInbox::receive_image(std::size_t topic, const LiveMessage& message, std::int64_t now) {
  LiveCamera& camera = *cameras_[topics_[topic].camera];
  const bool is_depth = topics_[topic].role == LiveRole::depth;
  M image;
  if (!decode(topic, message, now, image)) {
    if (is_depth) camera.drop_unreadable();
    return;
  }
  if (is_depth)
    camera.take_depth(keep_image(image, message.owner), now);
  else
    camera.take_color(keep_image(image, message.owner));
}

void LiveInbox::receive_targets(std::size_t topic, const LiveMessage& message, std::int64_t now) {
  const std::string& type = topics_[topic].type;
  if (type == message_type<Detection2DArrayMessage>())
    receive_targets_as<Detection2DArrayMessage>(topic, message, now);
  else if (type == message_type<Detection3DArrayMessage>())
    receive_targets_as<Detection3DArrayMessage>(topic, message, now);
  else if (type == message_type<KeypointsMessage>())
    receive_targets_as<KeypointsMessage>(topic, message, now);
  else
    receive_targets_as<PoseStampedMessage>(topic, message, now);
}

template <typename M>
void LiveInbox::receive_targets_as(std::size_t topic, const LiveMessage& message,
                                   std::int64_t now) {
  M found;
  if (!decode(topic, message, now, found)) return;
  // Pixel coordinates belong to the camera that the message names. If no camera has that frame, all
  // cameras take the message and report the mismatch.
  const auto is_meant = [&](const std::unique_ptr<LiveCamera>& camera) {
    return is_of_pixels<M> && camera->setup() != nullptr &&
           frame_name(camera->setup()->cameras.judged.frame_id) ==
               frame_name(found.header.frame_id);
  };
  const bool any_is_meant = std::any_of(cameras_.begin(), cameras_.end(), is_meant);
  for (const auto& camera : cameras_)
    if (!any_is_meant || is_meant(camera)) camera->take_targets(topics_[topic].name, found);
}

void LiveInbox::done(std::size_t camera, const LiveOutcome& outcome, std::int64_t now,
                     std::int64_t system_now) {
  cameras_[camera]->done(outcome);
  LiveTally& tally = tallies_[camera];
  tally.last = outcome;
  if (outcome.renderer) tally.renderer = outcome.renderer;
  if (!outcome.is_published) return;
  tally.last_published = now;
  ++tally.statuses[std::string(to_string(outcome.status))];
  tally.processing.add(static_cast<double>(now - outcome.arrived) * 1e-6);
  const std::int64_t latency = system_now - outcome.stamp;
  if (latency >= 0 && latency < longest_latency)
    tally.latency.add(static_cast<double>(latency) * 1e-6);
  else
    ++tally.beyond_clock;
}

}  // namespace penumbra::io
