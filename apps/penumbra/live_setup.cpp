// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <set>
#include <string>

#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/live_setup.hpp>
#include <io/files/printable.hpp>
#include <io/live/live_fusion.hpp>

namespace penumbra::app {

io::NameResolver live_names(const LiveArguments& arguments) {
  io::NameResolver names(arguments.name_space);
  for (const std::string& rule : arguments.remaps) names.remap(rule);
  return names;
}

io::DiagnosticSource diagnostic_source(const io::NameResolver& names) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string& space = names.name_space();
  return {.name = "penumbra" + (space.empty() ? "" : " " + space), .hardware_id = host.data()};
}

std::string result_name(const std::string& camera, const io::ResultTopic& topic) {
  return "penumbra/" + (camera.empty() ? "" : camera + "/") + std::string(topic.name);
}

std::array<std::string, 3> cloud_result_names(const std::string& topic) {
  const std::string name = (topic.starts_with('/') ? "penumbra" : "penumbra/") + topic;
  return {name, name + "/labelled", name + "/targets"};
}

std::string target_views_name() { return "penumbra/" + std::string(io::target_views_topic); }

void check_remaps(const io::NameResolver& names, const std::vector<io::CameraInputOptions>& cameras,
                  const std::vector<io::CloudInputOptions>& clouds) {
  static_cast<void>(names.resolve(diagnostics_topic));
  static_cast<void>(names.resolve(target_views_name()));
  std::vector<std::string> of_cameras;
  of_cameras.reserve(cameras.size() + 1);
  for (const io::CameraInputOptions& camera : cameras) of_cameras.push_back(camera.name);
  if (of_cameras.empty() && clouds.empty()) of_cameras.emplace_back();
  std::set<std::string> taken;
  for (const std::string& camera : of_cameras)
    for (const io::ResultTopic& topic : io::result_topics)
      taken.insert(names.resolve(result_name(camera, topic)));
  for (const io::CloudInputOptions& cloud : clouds)
    for (const std::string& name : cloud_result_names(cloud.topic))
      if (!taken.insert(names.resolve(name)).second)
        throw InputError("--cloud " + io::printable(cloud.topic) + ": " + names.resolve(name) +
                         " is already the topic of a camera's result or of another cloud's; name "
                         "the camera (--camera NAME=TOPIC), or --remap one");
  if (const auto unused = names.unused(); !unused.empty())
    throw InputError("--remap '" + io::printable(unused.front()) +
                     "': no topic has this name; topics that are found by their type are named by "
                     "their own options, for example --depth-topic");
}

io::LiveOptions live_options(const LiveArguments& arguments, const io::NameResolver& names) {
  const io::BagOptions& topics = arguments.session.input.bag;
  io::LiveOptions options;
  options.drift = arguments.session.drift;
  options.points = arguments.points;
  options.points_rate = arguments.points_rate;
  options.robot.robot.packages = topics.packages;
  options.robot.robot.arguments = topics.arguments;
  arguments.session.input.apply_to(options.robot.robot);
  options.robot.compare_sources = !topics.first_publisher;
  options.robot.joint_names = topics.joint_names;
  if (topics.robot) options.robot.given = Robot::load(*topics.robot, options.robot.robot);
  options.poses = topics.poses.value_or(PoseSource::joints);
  options.description_topics = {names.resolve("robot_description")};
  options.transform_topic = names.resolve("/tf");
  options.static_transform_topic = names.resolve("/tf_static");
  options.planning_scene_topics = {names.resolve("monitored_planning_scene")};
  options.attached_topics = {names.resolve("attached_collision_object")};
  options.plan_topic = names.resolve("display_planned_path");
  for (const std::string& name : topics.plan_topics)
    options.motion_topics.push_back(names.resolve(name));
  options.joint_topics = {names.resolve("joint_states")};
  if (!topics.robot_namespaces.empty())
    io::set_robots(options, topics.robot_namespaces,
                   [&](const std::string& name) { return names.resolve(name); });
  if (!topics.joint_topics.empty()) options.joint_topics.clear();
  for (const std::string& name : topics.joint_topics)
    options.joint_topics.push_back(names.resolve(name));
  for (const std::string& name : topics.target_topics)
    options.target_topics.push_back(names.resolve(name));
  return options;
}

}  // namespace penumbra::app
