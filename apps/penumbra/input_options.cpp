// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/ros/name_resolver.hpp>

namespace penumbra::app {
namespace {

DriftLimits to_drift_limits(const std::string& text) {
  const std::vector<double> limits = io::parse_numbers(text);
  if (limits.size() != 2) refuse_option("--drift-limits", text, "MM,DEGREES: two numbers");
  const DriftLimits drift{.position = 1e-3 * limits[0],
                          .rotation = limits[1] * std::numbers::pi / 180.0};
  drift.check();
  return drift;
}

/// Adds an option for each setting of the label rule: front_min_width as --front-min-width.
void add_rule(CLI::App& app, io::RuleOptions& rule) {
  add_settings<LabelRule>(app, [&rule](const auto& setting, const auto& numbers) {
    return rule.give(setting, numbers);
  });
}

/// Targets come from a file or from topics. Pixels in topics are those of the camera's images.
void check_targets(const io::SessionOptions& session) {
  if (session.input.bag.target_topics.empty()) return;
  if (session.targets || session.no_targets)
    throw InputError("--target-topic: --targets is given too; leave one of them out");
  if (session.image == ImageSpace::rectified)
    throw InputError(
        "--target-topic: its pixels are those of the camera's images; leave --image rectified out");
}

}  // namespace

void add_path(CLI::App& app, io::InputOptions& input) {
  add_text(app, "INPUT",
           "a recording folder or its recording.yaml, or a bag of ROS 2: *.mcap, *.db3, or a "
           "folder with metadata.yaml",
           "", input.path)
      ->required();
}

void add_input(CLI::App& app, io::InputOptions& input) {
  add_path(app, input);
  add_option(app, "--camera", "one of a recording's cameras", "NAME",
             [&](const std::string& name) { input.camera = name; });
}

void add_sequence(CLI::App& app, io::SessionOptions& session) {
  add_choice<ImageSpace>(
      app, "--image", "raw (default): results fit the recorded images; or rectified", session.image,
      {{"raw", ImageSpace::raw}, {"rectified", ImageSpace::rectified}});
  add_frames(app, session.input.frames);
  add_option(app, "--targets", "which targets to judge, or none; default: the recording's, if any",
             "YAML", [&](const std::string& text) {
               if (text.empty()) refuse_option("--targets", text, "a path, or none");
               session.no_targets = text == "none";
               if (!session.no_targets) session.targets = text;
             });
}

void check_session(const CLI::App& app, io::SessionOptions& session) {
  check_renderer(session.backend, session.renderer);
  check_targets(session);
  note_bag_option(app, session.input);
}

void check_planned(const CLI::App& app, io::InputOptions& input) {
  note_bag_option(app, input);
  if (!input.bag.target_topics.empty())
    throw InputError("--target-topic: targets come from the file of --targets; leave it out");
}

void add_camera(std::vector<NamedCamera>& cameras, const std::string& name,
                const std::string& depth_topic) {
  try {
    static_cast<void>(io::NameResolver().resolve("penumbra/" + name));
  } catch (const InputError&) {
    refuse_option("--camera", name, "a name of letters, digits and _, no digit first");
  }
  for (const NamedCamera& camera : cameras)
    if (camera.name == name) throw InputError("--camera: " + name + " is given twice");
  cameras.push_back({name, depth_topic});
}

void note_bag_option(const CLI::App& app, io::InputOptions& input) {
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0 && option->get_group() == BagHelp().group)
      input.bag_option = option->get_name();
}

void add_bag_robot(CLI::App& app, io::BagOptions& bag, const BagHelp& help) {
  add_list(app, "--joint-topic", "default: " + help.joints + "; may be given several times",
           "TOPIC", [&](const std::string& text) { bag.joint_topics.push_back(text); });
  add_choice<PoseSource>(
      app, "--poses",
      "where the links' poses come from: joints, tf, or both, which must agree; default: " +
          help.poses,
      bag.poses,
      {{"joints", PoseSource::joints}, {"tf", PoseSource::transforms}, {"both", PoseSource::both}});
  add_text(
      app, "--joint-names",
      "the joints' names in joint states, if they differ: 'left/*=*' if those begin with left/",
      "MESSAGE=JOINT", bag.joint_names);
  add_text(app, "--robot", "the robot, in place of the robot_description", "URDF", bag.robot);
  add_list(app, "--robot-namespace",
           "one of several robots: topics NS/robot_description and NS/joint_states, frames NS/LINK "
           "below 'world' in tf; give it for each",
           "NS", [&](const std::string& text) {
             const std::string name = text.substr(text.starts_with('/') ? 1 : 0);
             if (name.empty() || name.find('/') != std::string::npos)
               refuse_option("--robot-namespace", text, "a name without '/'");
             bag.robot_namespaces.push_back(name);
           });
  for (const char* const of_one : {"--robot", "--joint-topic"})
    app.get_option("--robot-namespace")->excludes(app.get_option(of_one));
  add_packages(app, bag.packages, bag.arguments);
  add_option(app, "--frame-prefix",
             "before link names in tf, as robot_state_publisher's frame_prefix: left/", "TEXT",
             [&](const std::string& text) {
               if (text.empty()) refuse_option("--frame-prefix", text, "a TEXT");
               bag.frame_prefix = text.substr(text[0] == '/');
             });
  app.add_flag("--first-publisher", bag.first_publisher,
               "do not compare several publishers of one joint or transform: use the first one "
               "heard; default: where they disagree, the pose is unknown");
  add_text(app, "--parent",
           "link that the " + help.sensor + " is on; default: the first above its frame in tf",
           "LINK", bag.parent);
  add_text(app, "--pose",
           "4x4 pose of the " + help.frame + " in the parent link, metres, in place of tf's",
           "FILE", bag.pose);
  if (help.time_offset)
    add_number(app, "--time-offset",
               "added to the stamps of " + help.data + " before poses are looked up; default 0",
               "S", bag.time_offset, -10.0, 10.0);
}

void add_bag(CLI::App& app, io::BagOptions& bag, const BagHelp& help) {
  const std::size_t first = app.get_options().size();
  add_text(app, "--depth-topic", "depth images; default: the only ones called depth", "TOPIC",
           bag.depth_topic);
  add_text(app, "--camera-info-topic", "default: next to the depth images", "TOPIC",
           bag.camera_info_topic);
  add_text(app, "--color-topic",
           "judge in this camera's image: depth is brought there by tf, if it is another's",
           "TOPIC", bag.color_topic);
  app.add_flag("--no-depth", bag.no_depth,
               "the camera measures no depth: judge its colour images by the robot's model alone");
  add_list(app, "--target-topic",
           "Detection2DArray, Detection3DArray, Keypoints or PoseStamped to judge; may be given "
           "several times",
           "TOPIC", [&](const std::string& text) { bag.target_topics.push_back(text); });
  add_list(app, "--plan-topic",
           "JointTrajectory that the robot follows; default: MoveIt's display_planned_path; may be "
           "given several times",
           "TOPIC", [&](const std::string& text) { bag.plan_topics.push_back(text); });
  add_text(app, "--camera-frame", "the images' frame in tf, in place of their frame_id", "FRAME",
           bag.camera_frame);
  add_number(app, "--depth-scale",
             "metres per unit of the depth images; default: 0.001 for integers, 1 for floats", "M",
             bag.depth_scale, 1e-9, 1e3);
  add_choice<bool>(
      app, "--depth-along",
      "what the depth images have: the z-component, or the distance along each pixel's "
      "ray, as some simulators write it",
      bag.depth_along_ray, {{"z", false}, {"ray", true}});
  app.add_flag("--rectified", bag.rectified,
               "the images are free of distortion already, as those called image_rect... are");
  add_bag_robot(app, bag, help);
  const auto options = app.get_options();
  for (std::size_t i = first; i < options.size(); ++i) options[i]->group(help.group);
}

void add_session(CLI::App& app, io::SessionOptions& session, const std::string& geometry_default) {
  io::InputOptions& input = session.input;
  io::RuleOptions& rule = session.rule;
  add_renderer(app, session.backend, session.renderer);
  add_drawn(app, input, geometry_default);
  add_rule(app, rule);
  add_option(app, "--sensor",
             "realsense_d4xx (default), zed, tof, structured_light or none: their tolerance and "
             "fringe reach; the two options override",
             "NAME", [&](const std::string& text) {
               static_cast<void>(LabelRule::for_sensor(text));
               rule.sensor = text;
             });
  add_option(app, "--drift-limits",
             "how far a camera may be from its calibration without a note; default 2,0.1",
             "MM,DEGREES", [&](const std::string& text) { session.drift = to_drift_limits(text); });
  add_choice<bool>(app, "--labels",
                   "full (default), or paper: constant 0.01 m, no clean-up, no fringe, no beyond; "
                   "--tolerance and the other settings override",
                   rule.paper_labels, {{"full", false}, {"paper", true}});
}

}  // namespace penumbra::app
