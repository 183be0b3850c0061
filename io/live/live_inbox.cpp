// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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

}  // namespace

void set_robots(LiveOptions& options, const std::vector<std::string>& namespaces,
                const std::function<std::string(const std::string&)>& resolve) {
  options.robot.names = namespaces;
  options.description_topics.clear();
  options.joint_topics.clear();
  for (const std::string& robot : namespaces) {
    options.description_topics.push_back(resolve(robot + "/robot_description"));
    options.joint_topics.push_back(resolve(robot + "/joint_states"));
    options.planning_scene_topics.push_back(resolve(robot + "/monitored_planning_scene"));
    options.attached_topics.push_back(resolve(robot + "/attached_collision_object"));
  }
}

LiveInbox::LiveInbox(const LiveOptions& options)
    : FrameAssembler(options.robot, options.cameras, options.clouds),
      options_(options),
      tallies_(sensor_count()) {
  add_topics_of_robot();
  for (std::size_t i = 0; i < options_.cameras.size(); ++i) add_topics_of_camera(i);
  for (std::size_t i = 0; i < options_.clouds.size(); ++i)
    add_topic({.role = TopicRole::cloud, .camera = i, .name = options_.clouds[i].topic});
}

void LiveInbox::add_topics_of_robot() {
  const std::vector<std::string>& robots = options_.robot.names;
  for (std::size_t i = 0; i < robots.size() && !options_.robot.given; ++i)
    add_topic({.role = TopicRole::description,
               .robot = robots[i],
               .name = options_.description_topics[i],
               .type = message_type<StringMessage>(),
               .latched = true});
  for (std::size_t i = 0; i < options_.joint_topics.size(); ++i)
    if (options_.poses != PoseSource::transforms)
      add_topic({.role = TopicRole::joints,
                 .robot = robots.size() == 1 ? robots[0] : robots[i],
                 .name = options_.joint_topics[i],
                 .type = message_type<JointStateMessage>()});
  add_topic({.role = TopicRole::transforms,
             .name = options_.transform_topic,
             .type = message_type<TfMessage>()});
  add_topic({.role = TopicRole::static_transforms,
             .name = options_.static_transform_topic,
             .type = message_type<TfMessage>(),
             .latched = true});
  for (std::size_t i = 0; i < options_.attached_topics.size(); ++i) {
    const std::string robot = i == 0 ? "" : robots[i - 1];
    add_topic({.role = TopicRole::attached,
               .robot = robot,
               .name = options_.planning_scene_topics[i],
               .type = message_type<PlanningSceneMessage>()});
    add_topic({.role = TopicRole::attached,
               .robot = robot,
               .name = options_.attached_topics[i],
               .type = message_type<AttachedObjectMessage>()});
  }
  add_topic({.role = TopicRole::plan,
             .name = options_.plan_topic,
             .type = message_type<DisplayTrajectoryMessage>()});
  for (const std::string& name : options_.motion_topics)
    add_topic(
        {.role = TopicRole::plan, .name = name, .type = message_type<JointTrajectoryMessage>()});
  for (const std::string& name : options_.target_topics)
    add_topic({.role = TopicRole::targets, .name = name});
}

void LiveInbox::add_topics_of_camera(std::size_t camera) {
  const CameraInputOptions& options = options_.cameras[camera];
  const auto add = [&](TopicRole role, const std::string& name, const std::string& type) {
    if (!name.empty()) add_topic({.role = role, .camera = camera, .name = name, .type = type});
  };
  add(TopicRole::camera_info, options.info_topic, message_type<CameraInfoMessage>());
  add(TopicRole::color_info, options.color_info_topic, message_type<CameraInfoMessage>());
  add(TopicRole::color, options.color_topic, type_of_images(options.color_topic));
  add(TopicRole::depth, options.depth_topic, type_of_images(options.depth_topic));
}

void LiveInbox::done(std::size_t sensor, const LiveOutcome& outcome, std::int64_t now,
                     std::int64_t system_now) {
  FrameAssembler::done(sensor, outcome.is_published, outcome.unjudged_targets);
  LiveTally& tally = tallies_[sensor];
  tally.last = outcome;
  if (outcome.renderer) tally.renderer = outcome.renderer;
  if (!outcome.is_published) return;
  tally.last_published = now;
  tally.points.add(outcome.pixels);
  tally.parts = std::max(tally.parts, outcome.parts);
  if (tally.time_note.empty()) tally.time_note = outcome.time_note;
  ++tally.statuses[std::string(to_string(outcome.status))];
  const bool is_ok = outcome.status == FrameStatus::ok;
  if (!is_ok) tally.last_trouble = std::string(to_string(outcome.status)) + ": " + outcome.message;
  tally.recent.emplace_back(now, is_ok);
  while (tally.recent.front().first < now - LiveTally::recent_time) tally.recent.pop_front();
  tally.processing.add(static_cast<double>(now - outcome.arrived) * 1e-6);
  const std::int64_t latency = system_now - outcome.stamp;
  if (latency >= 0 && latency < longest_latency)
    tally.latency.add(static_cast<double>(latency) * 1e-6);
  else
    ++tally.beyond_clock;
}

void LiveInbox::warn(std::size_t sensor, const std::shared_ptr<const SensorSetup>& setup,
                     std::vector<std::string> warnings) {
  tallies_[sensor].warned = setup;
  tallies_[sensor].warnings = std::move(warnings);
}

std::vector<std::string> LiveInbox::warnings(std::size_t number) const {
  const LiveTally& tally = tallies_[number];
  std::vector<std::string> lines;
  if (tally.warned.lock().get() == sensor(number).setup()) lines = tally.warnings;
  if (std::string moved = tally.last.drift.message(); !moved.empty()) lines.push_back(moved);
  return lines;
}

}  // namespace penumbra::io
