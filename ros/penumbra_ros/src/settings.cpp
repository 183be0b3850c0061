// SPDX-License-Identifier: Apache-2.0
#include "settings.hpp"

#include "outputs.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <type_traits>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_topics.hpp>
#include <io/assembly/joint_names.hpp>
#include <io/files/recording.hpp>
#include <io/files/settings.hpp>
#include <io/live/cloud_text.hpp>

namespace penumbra_ros {
namespace {

using penumbra::InputError;
using penumbra::LabelRule;
using penumbra::Setting;
using rcl_interfaces::msg::ParameterDescriptor;
using Texts = std::vector<std::string>;

constexpr bool changeable = true;

/// Reads parameters and declares those that are not declared. While the node is configured, only
/// those that are declared as `changeable` can change.
class Declaration {
 public:
  /// `before`: of the names.
  Declaration(rclcpp_lifecycle::LifecycleNode& node, Settings& settings, std::string before = "")
      : node_(node), settings_(settings), before_(std::move(before)) {}

  template <typename T>
  T operator()(const std::string& name, const T& value, const std::string& description,
               bool can_change = false) {
    return read(name, value, descriptor(description), can_change);
  }
  template <typename T>
  T number(const std::string& name, T value, T least, T most, const std::string& description,
           bool can_change = false) {
    ParameterDescriptor described = descriptor(description);
    const auto limit = [&](auto& ranges) {
      ranges.resize(1);
      ranges[0].from_value = least;
      ranges[0].to_value = most;
    };
    if constexpr (std::is_integral_v<T>)
      limit(described.integer_range);
    else
      limit(described.floating_point_range);
    return read(name, value, described, can_change);
  }
  template <typename T>
  T choice(const std::string& name, const std::string& value, const std::map<std::string, T>& of,
           const std::string& description) {
    ParameterDescriptor described = descriptor(description);
    for (const auto& [text, meaning] : of)
      described.additional_constraints +=
          (described.additional_constraints.empty() ? "one of " : ", ") +
          (text.empty() ? "empty" : text);
    const auto text = read(name, value, described, false);
    const auto found = of.find(text);
    if (found == of.end())
      throw InputError("parameter '" + before_ + name + "' is '" + text + "'; it must be " +
                       described.additional_constraints);
    return found->second;
  }
  /// Declares a list of "KEY=VALUE". `repeats`: a key may have several values.
  std::multimap<std::string, std::string> pairs(const std::string& name,
                                                const std::string& description,
                                                bool repeats = false) {
    std::multimap<std::string, std::string> pairs;
    for (const std::string& text : (*this)(name, Texts{}, description)) {
      const auto mark = text.find('=');
      if (mark == 0 || mark == std::string::npos)
        throw InputError("parameter '" + name + "': '" + text + "' is not of the form NAME=VALUE");
      const std::string key = text.substr(0, mark);
      if (!repeats && pairs.count(key) > 0)
        throw InputError("parameter '" + name + "': '" + key + "' is given twice");
      pairs.emplace(key, text.substr(mark + 1));
    }
    return pairs;
  }

 private:
  static ParameterDescriptor descriptor(const std::string& description) {
    ParameterDescriptor described;
    described.description = description;
    return described;
  }
  template <typename T>
  T read(const std::string& name, const T& value, const ParameterDescriptor& described,
         bool can_change) {
    settings_.parameters[before_ + name] = can_change;
    if (!node_.has_parameter(before_ + name))
      return node_.declare_parameter(before_ + name, value, described);
    return node_.get_parameter(before_ + name).get_value<T>();
  }

  rclcpp_lifecycle::LifecycleNode& node_;
  Settings& settings_;
  std::string before_;
};

template <typename T>
T value_of(const rclcpp_lifecycle::LifecycleNode& node, const Changes& changes,
           const std::string& name) {
  for (const rclcpp::Parameter& change : changes)
    if (change.get_name() == name) return change.get_value<T>();
  return node.get_parameter(name).get_value<T>();
}

double to_number(const std::string& name, const std::string& text) {
  try {
    std::size_t read = 0;
    const double number = std::stod(text, &read);
    if (read == text.size()) return number;
  } catch (const std::logic_error&) {
  }
  throw InputError("parameter '" + name + "': '" + text + "' is not a number");
}

std::string resolved(rclcpp_lifecycle::LifecycleNode& node, const std::string& topic) {
  return node.get_node_topics_interface()->resolve_topic_name(topic);
}

std::vector<std::string> resolved(rclcpp_lifecycle::LifecycleNode& node, Texts topics) {
  for (std::string& topic : topics) topic = resolved(node, topic);
  return topics;
}

penumbra::RobotOptions declare_robot(Declaration& declare) {
  using penumbra::Geometry;
  penumbra::RobotOptions robot;
  for (const auto& [name, folder] : declare.pairs(
           "packages",
           "NAME=DIR: where package://NAME is, if the ament index does not have the package"))
    robot.packages[name] = folder;
  for (const auto& [name, value] :
       declare.pairs("arguments", "NAME=VALUE: arguments of the robot's xacro file"))
    robot.arguments[name] = value;
  robot.geometry = declare.choice<std::optional<Geometry>>(
      "geometry", "",
      {{"", std::nullopt}, {"collision", Geometry::collision}, {"visual", Geometry::visual}},
      "geometry of the URDF that is drawn; empty: collision, and visual for links that have no "
      "other");
  robot.geometry_fallback = declare("geometry_fallback", false,
                                    "draw links that lack the chosen geometry with the other one");
  robot.allow_missing_meshes = declare(
      "allow_missing_meshes", false, "go on without meshes that cannot be read; results name them");
  robot.ignore_links =
      declare("ignore_links", Texts{},
              "patterns of links that are not drawn; of several robots ROBOT/PATTERN");
  for (const auto& [joint, position] :
       declare.pairs("joints",
                     "NAME=VALUE: joints that do not move, or whose position is not "
                     "received, rad or m; of several robots ROBOT/NAME"))
    robot.joints[joint] = to_number("joints", position);
  robot.only_links = declare("only_links", Texts{}, "if not empty: patterns of the links drawn");
  for (const auto& [link, metres] :
       declare.pairs("margins", "LINK=METRES: by how much links are drawn larger; patterns"))
    robot.margins[link] = to_number("margins", metres);
  for (const auto& [link, mesh] :
       declare.pairs("extra", "LINK=FILE: meshes that links carry and the URDF lacks", true))
    robot.extra.push_back({link, mesh});
  return robot;
}

/// Declares what holds for all cameras and clouds. Returns their common options.
penumbra::io::CameraInputOptions declare_poses(Declaration& declare,
                                               penumbra::io::LiveOptions& live) {
  using penumbra::PoseSource;
  penumbra::io::CameraInputOptions common;
  live.poses = common.poses = declare.choice<PoseSource>(
      "poses", "joints",
      {{"joints", PoseSource::joints}, {"tf", PoseSource::transforms}, {"both", PoseSource::both}},
      "where the poses of the links come from");
  live.robot.compare_sources = !declare(
      "first_publisher", false, "do not compare several publishers of one joint or transform");
  live.robot.joint_names =
      declare("joint_names", std::string(),
              "the joints' names in joint states, if they differ: left/*=* if those begin with "
              "left/");
  static_cast<void>(penumbra::io::JointNames(live.robot.joint_names));  // throws
  common.mount.frame_prefix =
      declare("frame_prefix", std::string(), "before link names in TF, as robot_state_publisher's");
  using penumbra::io::HiddenTargets;
  common.hidden_targets =
      declare.choice<HiddenTargets>("handling", "none",
                                    {{"none", HiddenTargets::not_handled},
                                     {"predict", HiddenTargets::predict},
                                     {"hold", HiddenTargets::hold}},
                                    "what happens to targets while they are hidden");
  return common;
}

void declare_mount(Declaration& declare, penumbra::io::CameraInputOptions& camera) {
  penumbra::io::BagOptions mount;
  mount.frame_prefix = camera.mount.frame_prefix;
  const auto set = [&](auto& option, const char* name, const char* description) {
    if (const auto text = declare(name, std::string(), description); !text.empty()) option = text;
  };
  set(mount.camera_frame, "camera_frame", "frame of the images in TF, in place of their frame_id");
  set(mount.parent, "parent", "link that carries the camera; empty: the first above its frame");
  set(mount.pose, "pose",
      "file with the 4x4 pose of the optical frame in the parent link, metres, in place of TF's");
  camera.mount = penumbra::io::mount_options(mount);
  camera.time_offset = declare.number("time_offset", 0.0, -10.0, 10.0,
                                      "seconds added to image stamps before poses are looked up");
  camera.max_frames = static_cast<std::size_t>(
      declare.number<std::int64_t>("queue", 8, 1, 1000, "images that may wait for their pose"));
}

void declare_topics(rclcpp_lifecycle::LifecycleNode& node, Declaration& declare,
                    penumbra::io::LiveOptions& live) {
  live.description_topics = {resolved(node, "robot_description")};
  live.transform_topic = resolved(node, "/tf");
  live.static_transform_topic = resolved(node, "/tf_static");
  live.planning_scene_topics = {resolved(node, "monitored_planning_scene")};
  live.attached_topics = {resolved(node, "attached_collision_object")};
  live.plan_topic = resolved(node, "display_planned_path");
  live.motion_topics =
      resolved(node, declare("plan_topics", Texts{},
                             "topics of trajectory_msgs/JointTrajectory that the robot follows"));
  live.joint_topics =
      resolved(node, declare("joint_topics", Texts{"joint_states"}, "topics of joint states"));
  const Texts robots =
      declare("robot_namespaces", Texts{},
              "of several robots: topics NS/robot_description, NS/joint_states, frames NS/LINK");
  if (!robots.empty()) {
    penumbra::io::check_robots_of(live.robot.robot.joints, robots);
    penumbra::io::set_robots(live, robots,
                             [&](const std::string& name) { return resolved(node, name); });
  }
  live.target_topics = resolved(
      node, declare("target_topics", Texts{},
                    "Detection2DArray, Detection3DArray, Keypoints or PoseStamped to judge"));
}

/// Returns the NAME of all parameters cameras.NAME.PARAMETER.
std::set<std::string> cameras_of(rclcpp_lifecycle::LifecycleNode& node) {
  const std::string before = "cameras.";
  std::set<std::string> names;
  for (const auto& [name, value] : node.get_node_parameters_interface()->get_parameter_overrides())
    if (name.rfind(before, 0) == 0)
      names.insert(name.substr(before.size(), name.find('.', before.size()) - before.size()));
  return names;
}

/// Declares a camera. `depth_topic`: its default. Returns false without a topic.
bool declare_camera(rclcpp_lifecycle::LifecycleNode& node, Declaration& declare,
                    const std::string& depth_topic, penumbra::io::CameraInputOptions& camera) {
  declare_mount(declare, camera);
  const auto depth = declare("depth_topic", depth_topic,
                             "depth images; a name that ends in /compressed or /compressedDepth is "
                             "a CompressedImage");
  if (!depth.empty()) camera.depth_topic = resolved(node, depth);
  const auto info = declare("camera_info_topic", std::string(), "empty: next to the depth images");
  camera.info_is_named = !info.empty();
  if (!depth.empty() || !info.empty())
    camera.info_topic = info.empty() ? penumbra::io::camera_info_topic(camera.depth_topic) : info;
  if (!camera.info_topic.empty()) camera.info_topic = resolved(node, camera.info_topic);
  const auto color = declare("color_topic", std::string(),
                             "judge in this camera's image: depth is brought there by TF");
  if (!color.empty()) {
    camera.color_topic = resolved(node, color);
    camera.color_info_topic = resolved(node, penumbra::io::camera_info_topic(camera.color_topic));
  }
  camera.has_depth = declare("has_depth", true,
                             "false: there is no depth camera, and the images of color_topic are "
                             "judged by the robot's model alone");
  if (!camera.has_depth) {
    if (color.empty()) throw penumbra::InputError("has_depth: false needs a color_topic");
    camera.depth_topic = camera.color_topic;
    if (info.empty()) camera.info_topic = camera.color_info_topic;
    camera.color_topic.clear();
  }
  if (const double scale = declare.number(
          "depth_scale", 0.0, 0.0, 1000.0,
          "metres per unit of the depth images; 0: 0.001 for integers, 1 for floats");
      scale > 0.0)
    camera.depth_scale = scale;
  camera.depth_along_ray = declare.choice<bool>(
      "depth_along", "z", {{"z", false}, {"ray", true}},
      "what the depth images have: the z-component, or the distance along each pixel's ray");
  camera.is_rectified = declare(
      "rectified", false, "the images have no lens distortion, as those called image_rect...");
  return !camera.depth_topic.empty();
}

void declare_cameras(rclcpp_lifecycle::LifecycleNode& node,
                     const penumbra::io::CameraInputOptions& common, Settings& settings) {
  auto& cameras = settings.live.cameras;
  const std::set<std::string> names = cameras_of(node);
  for (const std::string& name : names) {
    Declaration declare(node, settings, "cameras." + name + ".");
    cameras.push_back(common);
    cameras.back().name = name;
    if (!declare_camera(node, declare, "", cameras.back()))
      throw InputError("parameter 'cameras." + name + ".depth_topic' is missing");
  }
  if (!names.empty()) return;
  Declaration declare(node, settings);
  penumbra::io::CameraInputOptions camera = common;
  if (declare_camera(node, declare, settings.live.clouds.empty() ? "depth/image" : "", camera))
    cameras.push_back(camera);
}

void declare_clouds(rclcpp_lifecycle::LifecycleNode& node, Declaration& declare,
                    const penumbra::io::CameraInputOptions& common, Settings& settings) {
  for (const std::string& text :
       declare("clouds", Texts{},
               "PointCloud2, LaserScan or CustomMsg to publish without the robot: TOPIC, or TOPIC "
               "and words as sensor=ouster_os1 tolerance=0.03,0,0 merged sensor_frame=FRAME "
               "ignore_times removed_ranges=inf")) {
    penumbra::io::CloudInputOptions cloud = penumbra::io::parse_cloud(text);
    const std::string given = cloud.topic;
    cloud.topic = resolved(node, given);
    const std::string below = given.front() == '/' ? "~" : "~/";
    settings.cloud_topics.push_back(
        resolved(node, given.front() == '~' ? "~" + cloud.topic : below + given));
    cloud.mount = common.mount;
    cloud.hidden_targets = common.hidden_targets;
    cloud.poses = common.poses;
    cloud.has_targets = !settings.live.target_topics.empty();
    settings.live.clouds.push_back(cloud);
  }
}

/// The type of a parameter that is a number.
template <typename Value>
using Stored = std::conditional_t<std::is_integral_v<Value>, std::int64_t, double>;

void declare_rule(Declaration& declare) {
  declare("sensor", std::string(),
          "realsense_d4xx (the default), zed, tof, structured_light or none: sets tolerance and "
          "fringe_reach",
          changeable);
  penumbra::for_each_setting<LabelRule>(
      [&]<typename Value>(const Setting<LabelRule, Value>& setting) {
        const std::string meaning = setting.meaning;
        if constexpr (penumbra::NumberSetting<Value>)
          declare.number<Stored<Value>>(setting.name, -1, -1,
                                        static_cast<Stored<Value>>(setting.range.most),
                                        meaning + "; -1: default", changeable);
        else
          declare(setting.name, std::vector<double>{}, meaning + "; empty: default", changeable);
      });
  declare("labels", std::string("full"), "full or paper (constant 0.01 m, no clean-up)",
          changeable);
}

/// Throws InputError if a camera and a sensor of clouds, or two of these, publish on one topic.
void check_names(rclcpp_lifecycle::LifecycleNode& node, const Settings& settings) {
  std::set<std::string> taken;
  for (const penumbra::io::CameraInputOptions& camera : settings.live.cameras)
    for (const char* name : output_names)
      taken.insert(resolved(node, "~/" + (camera.name.empty() ? "" : camera.name + "/") + name));
  for (const std::string& topic : settings.cloud_topics)
    for (const char* end : {"", "/labelled", "/targets"})
      if (!taken.insert(topic + end).second)
        throw InputError("parameter 'clouds': " + topic + end +
                         " is already the topic of a camera's result or of another cloud's; name "
                         "the camera, by cameras.NAME.depth_topic");
}

}  // namespace

penumbra::LabelRule read_rule(const rclcpp_lifecycle::LifecycleNode& node, const Changes& changes) {
  const auto labels = value_of<std::string>(node, changes, "labels");
  if (labels != "full" && labels != "paper")
    throw InputError("parameter 'labels' is '" + labels + "'; it must be one of full, paper");
  penumbra::io::RuleOptions options{.paper_labels = labels == "paper"};
  if (const auto sensor = value_of<std::string>(node, changes, "sensor"); !sensor.empty())
    options.sensor = sensor;
  penumbra::for_each_setting<LabelRule>(
      [&]<typename Value>(const Setting<LabelRule, Value>& setting) {
        std::vector<double> numbers;
        if constexpr (penumbra::NumberSetting<Value>)
          numbers = {static_cast<double>(value_of<Stored<Value>>(node, changes, setting.name))};
        else
          numbers = value_of<std::vector<double>>(node, changes, setting.name);
        const bool is_default = numbers.empty() || numbers == std::vector{-1.0};
        if (!is_default && !options.give(setting, numbers))
          throw InputError("parameter '" + std::string(setting.name) + "': expected " +
                           expected_of(setting));
      });
  return options.applied_to({});
}

std::set<std::string> read_publish(const rclcpp_lifecycle::LifecycleNode& node,
                                   const Changes& changes) {
  const auto names = value_of<Texts>(node, changes, "publish");
  for (const std::string& name : names)
    if (std::find(output_names.begin(), output_names.end(), name) == output_names.end())
      throw InputError("parameter 'publish': there is no result '" + name + "'");
  return {names.begin(), names.end()};
}

Settings read_settings(rclcpp_lifecycle::LifecycleNode& node) {
  Settings settings;
  Declaration declare(node, settings);
  settings.live.robot.robot = declare_robot(declare);
  declare_topics(node, declare, settings.live);
  const penumbra::io::CameraInputOptions common = declare_poses(declare, settings.live);
  declare_clouds(node, declare, common, settings);
  declare_cameras(node, common, settings);
  check_names(node, settings);
  const auto urdf =
      declare("robot", std::string(), "URDF, xacro or MJCF file, in place of robot_description");
  if (!urdf.empty())
    settings.live.robot.given = penumbra::Robot::load(urdf, settings.live.robot.robot);

  using penumbra::Backend;
  settings.pipeline.backend = declare.choice<Backend>(
      "renderer", "cpu",
      {{"cpu", Backend::cpu}, {"gl", Backend::gl}, {"reference", Backend::reference}},
      "renderer of the virtual depth");
  settings.pipeline.renderer.threads = static_cast<int>(
      declare.number<std::int64_t>("threads", 1, 1, 64, "threads of the cpu renderer"));
  if (!settings.live.target_topics.empty())
    settings.pipeline.target_history = penumbra::io::topic_target_history;
  declare_rule(declare);
  settings.pipeline.rule = read_rule(node);

  const auto drift = declare("drift_limits", std::vector<double>{2.0, 0.1},
                             "millimetres and degrees that the camera may be from its calibration");
  if (drift.size() != 2)
    throw InputError("parameter 'drift_limits' must have two numbers: millimetres, degrees");
  settings.live.drift = {.position = 1e-3 * drift[0],
                         .rotation = drift[1] * std::numbers::pi / 180.0};
  settings.live.drift.check();
  using penumbra::PointsRule;
  PointsRule& points = settings.live.points;
  penumbra::for_each_setting<PointsRule>(
      [&]<typename Value>(const penumbra::Setting<PointsRule, Value>& setting) {
        points.*setting.member = static_cast<Value>(declare.number<Stored<Value>>(
            setting.name, points.*setting.member, static_cast<Stored<Value>>(setting.range.least),
            static_cast<Stored<Value>>(setting.range.most), setting.meaning));
      });
  points.check();
  settings.live.points_rate =
      declare.number("points_rate", 0.0, 0.0, 1000.0,
                     "point clouds a second of each camera, at most; 0: one for each image");
  declare("publish", Texts(output_names.begin(), output_names.end()),
          "results to publish; those without a subscriber are not computed", changeable);
  settings.publish = read_publish(node);
  settings.autostart = declare("autostart", true,
                               "configure and activate the node at the start; false: another does, "
                               "such as Nav2's lifecycle manager");
  settings.target_frames = declare("target_frames", false, "publish handled targets in TF");
  if (settings.target_frames && settings.live.cameras.size() > 1)
    throw InputError("parameter 'target_frames': TF can have the targets of one camera only");
  return settings;
}

}  // namespace penumbra_ros
