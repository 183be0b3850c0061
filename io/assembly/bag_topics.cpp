// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <concepts>
#include <initializer_list>
#include <map>
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_topics.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/files/names.hpp>
#include <io/files/printable.hpp>
#include <io/ros/foxglove_messages.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view image_type = "sensor_msgs/msg/Image";
constexpr std::string_view compressed_type = "sensor_msgs/msg/CompressedImage";
constexpr std::string_view video_type = "foxglove_msgs/msg/CompressedVideo";
constexpr std::array depth_types = {image_type, compressed_type};
constexpr std::array color_types = {image_type, compressed_type, video_type};
constexpr std::string_view info_type = "sensor_msgs/msg/CameraInfo";
constexpr std::string_view joints_type = "sensor_msgs/msg/JointState";
constexpr std::string_view transforms_type = "tf2_msgs/msg/TFMessage";
constexpr std::string_view scene_type = "moveit_msgs/msg/PlanningScene";
constexpr std::string_view attached_type = "moveit_msgs/msg/AttachedCollisionObject";
constexpr std::string_view plan_type = "moveit_msgs/msg/DisplayTrajectory";
constexpr std::string_view motion_type = "trajectory_msgs/msg/JointTrajectory";
constexpr std::string_view text_type = "std_msgs/msg/String";

constexpr std::array<std::string_view, 3> cloud_types = {
    "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/LaserScan", "livox_ros_driver2/msg/CustomMsg"};

using TopicTypes = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> target_types = {  // two of pixels, two of space
    "vision_msgs/msg/Detection2DArray", "penumbra_msgs/msg/Keypoints",
    "vision_msgs/msg/Detection3DArray", "geometry_msgs/msg/PoseStamped"};

bool holds(std::string_view name, std::initializer_list<std::string_view> words) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('/') + 1); }

/// Orders the encodings of one image: the least lossy first.
int loss(const std::string& topic) {
  const std::string base = image_base(topic);
  if (topic == base) return 0;
  if (topic == base + "/compressedDepth") return 1;
  return topic == base + "/compressed" ? 2 : 3;
}

std::string one_of(TopicTypes types) {
  std::string names;
  for (const std::string_view type : types) {
    if (!names.empty()) names += " or ";
    names += type;
  }
  return names;
}

std::string names_of(const std::vector<const BagTopic*>& topics) {
  std::string names;
  for (const BagTopic* topic : topics) {
    if (!names.empty()) names += ", ";
    names += printable(topic->name);
  }
  return names;
}

class Chooser {
 public:
  Chooser(const std::string& bag, std::span<const BagTopic> topics) : bag_(bag) {
    for (const BagTopic& topic : topics)
      if (!(topic.messages && *topic.messages == 0) && is_readable(topic.type, topic.encoding))
        topics_.push_back(&topic);
    if (topics_.empty()) refuse(nothing_in(topics));
  }

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(bag_ + ": " + what); }

  /// Returns all topics of these types. Results of Penumbra are no input unless they are named.
  [[nodiscard]] std::vector<const BagTopic*> of(TopicTypes types, bool with_results = false) const {
    std::vector<const BagTopic*> found;
    for (const BagTopic* topic : topics_)
      if (std::ranges::find(types, ros_type_of(topic->type)) != types.end() &&
          (with_results || topic->name.find("/penumbra/") == std::string::npos))
        found.push_back(topic);
    return found;
  }

  template <std::predicate<const std::string&> F>
  [[nodiscard]] std::vector<const BagTopic*> of(TopicTypes types, const F& is_one) const {
    auto found = of(types);
    std::erase_if(found, [&](const BagTopic* topic) { return !is_one(topic->name); });
    return found;
  }

  /// Returns the topic that an option names.
  [[nodiscard]] TopicUse named(const std::string& role, const std::string& option,
                               const std::string& name, TopicTypes types) const {
    const std::string why = "as " + option + " says";
    std::vector<std::string_view> known;
    for (const BagTopic* topic : of(types, true)) {
      if (topic->name == name) return use(role, *topic, why);
      known.push_back(topic->name);
    }
    const auto other = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const BagTopic* topic) { return topic->name == name; });
    if (other != topics_.end())
      refuse(option + ": " + name + " is of type " + printable((*other)->type) + "; expected " +
             one_of(types));
    refuse(option + ": there is no topic '" + name + "' with messages" + near_names(name, known));
  }

  /// Returns the only candidate. If one image was recorded in several encodings, returns the least
  /// lossy one.
  [[nodiscard]] TopicUse only_image(const std::string& role, const std::string& option,
                                    std::vector<const BagTopic*> candidates,
                                    const std::string& why) const {
    std::map<std::string, const BagTopic*> of_base;
    for (const BagTopic* topic : candidates) {
      const BagTopic*& best = of_base[image_base(topic->name)];
      if (best == nullptr || loss(topic->name) < loss(best->name)) best = topic;
    }
    if (of_base.size() == 1) return use(role, *of_base.begin()->second, why);
    candidates.clear();
    for (const auto& [base, topic] : of_base) candidates.push_back(topic);
    throw AmbiguousTopics(bag_ + ": several topics may be the " + role +
                          " images: " + names_of(candidates) + "; choose one with " + option);
  }

  [[nodiscard]] static TopicUse use(const std::string& role, const BagTopic& topic,
                                    const std::string& why) {
    return {role, topic.name, topic.type, why, topic.messages};
  }

 private:
  static std::string nothing_in(std::span<const BagTopic> topics) {
    for (const BagTopic& topic : topics)
      if (!is_readable(topic.type, topic.encoding))
        return "has no messages that can be read: those of " + printable(topic.name) + " (" +
               printable(topic.type) + ") are encoded as '" + printable(topic.encoding) +
               "'; expected cdr, or protobuf of Foxglove's schemas";
    return "holds no messages";
  }

  const std::string& bag_;
  std::vector<const BagTopic*> topics_;
};

bool is_depth(const std::string& name) {
  return holds(name, {"depth"}) && !holds(last_part(image_base(name)), {"confidence"});
}

bool is_color(const std::string& name) {
  return !is_depth(name) && holds(name, {"color", "colour", "rgb"});
}

TopicUse choose_depth(const Chooser& chooser, const BagOptions& options) {
  const TopicTypes types = depth_types;
  if (options.depth_topic)
    return chooser.named("depth", "--depth-topic", *options.depth_topic, types);
  const auto candidates = chooser.of(types, is_depth);
  if (!candidates.empty())
    return chooser.only_image("depth", "--depth-topic", candidates, "the only images called depth");
  const auto images = chooser.of(color_types);
  if (images.empty())
    chooser.refuse(std::string("has no images; depth images are needed") +
                   (chooser.of(cloud_types).empty() ? "" : "; `penumbra cloud` takes its clouds"));
  chooser.refuse(
      "no images are called depth; there are " + names_of(images) +
      "; choose one with --depth-topic; all commands but tune take colour images alone with "
      "--no-depth");
}

std::vector<TopicUse> choose_clouds(const Chooser& chooser, const BagOptions& options) {
  std::vector<TopicUse> uses;
  for (const std::string& name : options.cloud_topics)
    uses.push_back(chooser.named("cloud", "--topic", name, cloud_types));
  if (options.cloud_topics.empty())
    for (const BagTopic* topic : chooser.of(cloud_types))
      uses.push_back(Chooser::use("cloud", *topic, "by its type"));
  if (uses.empty())
    chooser.refuse("has no clouds (" + one_of(cloud_types) + "); `penumbra run` judges images");
  return uses;
}

/// Returns the camera_info topic next to an image topic, or null.
const BagTopic* find_info(const Chooser& chooser, const std::string& image) {
  const std::string wanted = camera_info_topic(image);
  const std::string folder = wanted.substr(0, wanted.rfind('/') + 1);
  const BagTopic* calibration = nullptr;  // Foxglove's, which have no usual name
  int calibrations = 0;
  for (const BagTopic* topic : chooser.of(TopicTypes(&info_type, 1))) {
    if (topic->name == wanted) return topic;
    if (topic->type == info_type || topic->name.substr(0, topic->name.rfind('/') + 1) != folder)
      continue;
    calibration = topic;
    ++calibrations;
  }
  return calibrations == 1 ? calibration : nullptr;
}

TopicUse choose_info(const Chooser& chooser, const BagOptions& options, const std::string& depth) {
  const char* const option = "--camera-info-topic";
  if (options.camera_info_topic)
    return chooser.named("camera_info", option, *options.camera_info_topic,
                         TopicTypes(&info_type, 1));
  if (const BagTopic* info = find_info(chooser, depth))
    return Chooser::use("camera_info", *info, "next to the depth images");
  const auto candidates = chooser.of(TopicTypes(&info_type, 1));
  if (candidates.size() == 1)
    return Chooser::use("camera_info", *candidates.front(), "the only one");
  if (candidates.empty())
    chooser.refuse("has no camera_info (sensor_msgs/msg/CameraInfo) of " + printable(depth));
  chooser.refuse("no camera_info topic is next to " + printable(depth) + ": " +
                 names_of(candidates) + "; choose one with " + option);
}

void choose_color(const Chooser& chooser, const BagOptions& options, bool with_color,
                  BagTopics& topics) {
  const TopicTypes types = color_types;
  if (options.color_topic) {
    topics.color = chooser.named("color", "--color-topic", *options.color_topic, types);
    const BagTopic* info = find_info(chooser, topics.color->name);
    if (info == nullptr)
      chooser.refuse("--color-topic: no camera_info is next to " + printable(*options.color_topic));
    if (info->name != topics.camera_info.name)  // else both are images of one camera
      topics.color_info = Chooser::use("color camera_info", *info, "next to these images");
    return;
  }
  if (!with_color) return;
  const auto candidates = chooser.of(types, is_color);
  if (!candidates.empty())
    topics.color = chooser.only_image("color", "--color-topic", candidates,
                                      "the only images called color, for overlays");
}

/// The colour images of a camera that measures no depth.
TopicUse choose_only_color(const Chooser& chooser, const BagOptions& options) {
  if (options.color_topic)
    return chooser.named("color", "--color-topic", *options.color_topic, color_types);
  const auto candidates = chooser.of(color_types, is_color);
  if (candidates.empty())
    chooser.refuse("no images are called color; choose those to judge with --color-topic");
  return chooser.only_image("color", "--color-topic", candidates, "the only images called color");
}

/// Returns the topic with the usual name, or the only one whose last part has that name.
std::optional<TopicUse> usual(const Chooser& chooser, const std::string& role,
                              std::string_view type, const std::string& name,
                              const std::string& choice) {
  const auto candidates = chooser.of(
      TopicTypes(&type, 1), [&](const std::string& other) { return last_part(other) == name; });
  for (const BagTopic* topic : candidates)
    if (topic->name == "/" + name) return Chooser::use(role, *topic, "by its name");
  if (candidates.size() == 1) return Chooser::use(role, *candidates.front(), "by its name");
  if (candidates.size() > 1)
    chooser.refuse("several topics are called " + name + ": " + names_of(candidates) + "; " +
                   choice);
  return std::nullopt;
}

/// Returns a topic of each of several robots.
std::vector<TopicUse> of_robots(const Chooser& chooser, const BagOptions& options,
                                const std::string& role, const std::string& name,
                                std::string_view type) {
  std::vector<TopicUse> uses;
  for (const std::string& robot : options.robot_namespaces) {
    uses.push_back(
        chooser.named(role, "--robot-namespace", "/" + robot + "/" + name, TopicTypes(&type, 1)));
    uses.back().robot = robot;
  }
  return uses;
}

void choose_joints(const Chooser& chooser, const BagOptions& options, BagTopics& topics) {
  if (options.poses == PoseSource::transforms) return;
  topics.joints = of_robots(chooser, options, "joints", "joint_states", joints_type);
  if (!topics.joints.empty()) return;
  for (const std::string& name : options.joint_topics)
    topics.joints.push_back(
        chooser.named("joints", "--joint-topic", name, TopicTypes(&joints_type, 1)));
  if (!topics.joints.empty()) return;
  const auto candidates = chooser.of(TopicTypes(&joints_type, 1));
  for (const BagTopic* topic : candidates)
    if (topic->name == "/joint_states")
      topics.joints = {Chooser::use("joints", *topic, "by its name")};
  if (!topics.joints.empty()) return;
  if (candidates.size() > 1)
    chooser.refuse("several topics may be the joint states: " + names_of(candidates) +
                   "; choose with --joint-topic, which may be given several times, or, for several "
                   "robots, with --robot-namespace");
  if (candidates.size() == 1)
    topics.joints = {Chooser::use("joints", *candidates.front(), "the only joint states")};
}

void choose_transforms(const Chooser& chooser, BagTopics& topics) {
  for (const char* const name : {"tf", "tf_static"})
    if (auto found = usual(chooser, "transforms", transforms_type, name,
                           "only recordings of one tree of frames can be read"))
      topics.transforms.push_back(std::move(*found));
  // Foxglove's have no usual names.
  for (const BagTopic* topic : chooser.of(TopicTypes(&transforms_type, 1)))
    if (topic->type != transforms_type &&
        std::ranges::find(topics.transforms, topic->name, &TopicUse::name) ==
            topics.transforms.end())
      topics.transforms.push_back(Chooser::use("transforms", *topic, "by its type"));
}

PoseSource choose_poses(const Chooser& chooser, const BagOptions& options,
                        const BagTopics& topics) {
  const PoseSource poses =
      options.poses.value_or(topics.joints.empty() ? PoseSource::transforms : PoseSource::joints);
  if (poses != PoseSource::transforms && topics.joints.empty())
    chooser.refuse("has no joint states (sensor_msgs/msg/JointState), which --poses asks for");
  if (!topics.transforms.empty()) return poses;
  if (poses == PoseSource::transforms)
    chooser.refuse("has neither joint states nor tf: the robot's poses are not known");
  if (poses == PoseSource::both) chooser.refuse("has no tf, which --poses both asks for");
  return poses;
}

}  // namespace

std::vector<TopicUse> BagTopics::all() const {
  std::vector<TopicUse> uses = clouds;
  if (clouds.empty()) uses = {depth, camera_info};
  for (const auto* one : {&color, &color_info})
    if (*one) uses.push_back(**one);
  for (const auto* several : {&descriptions, &joints, &transforms, &targets, &attached, &plans})
    uses.insert(uses.end(), several->begin(), several->end());
  return uses;
}

std::optional<TopicRole> BagTopics::role_of(const BagTopic& topic) const {
  const auto is = [&](const TopicUse& use) {
    return topic.name == use.name && topic.type == use.type;
  };
  const auto is_one_of = [&](const std::vector<TopicUse>& uses) {
    return std::any_of(uses.begin(), uses.end(), is);
  };
  if (is_one_of(clouds)) return TopicRole::cloud;
  if (is(depth)) return TopicRole::depth;
  if (is(camera_info)) return TopicRole::camera_info;
  if (color_info && is(*color_info)) return TopicRole::color_info;
  if (color && is(*color)) return TopicRole::color;
  if (is_one_of(descriptions)) return TopicRole::description;
  if (is_one_of(joints)) return TopicRole::joints;
  if (is_one_of(targets)) return TopicRole::targets;
  if (is_one_of(attached)) return TopicRole::attached;
  if (is_one_of(plans)) return TopicRole::plan;
  if (!joints.empty() && ros_type_of(topic.type) == joints_type) return TopicRole::unused_joints;
  if (!is_one_of(transforms)) return std::nullopt;
  return topic.name.ends_with("static") ? TopicRole::static_transforms : TopicRole::transforms;
}

std::string BagTopics::robot_of(const BagTopic& topic) const {
  for (const auto* of_robots : {&descriptions, &joints})
    for (const TopicUse& use : *of_robots)
      if (topic.name == use.name) return use.robot;
  return {};
}

std::string camera_info_topic(const std::string& image_topic) {
  const std::string base = image_base(image_topic);
  return base.substr(0, base.rfind('/') + 1) + "camera_info";
}

BagTopics choose_camera_topics(const std::string& source, std::span<const BagTopic> topics,
                               const BagOptions& options, bool with_color) {
  const Chooser chooser(source, topics);
  BagTopics chosen;
  chosen.has_depth = !options.no_depth;
  chosen.depth =
      options.no_depth ? choose_only_color(chooser, options) : choose_depth(chooser, options);
  chosen.camera_info = choose_info(chooser, options, chosen.depth.name);
  if (!options.no_depth) choose_color(chooser, options, with_color, chosen);
  return chosen;
}

BagTopics choose_topics(const std::string& bag, std::span<const BagTopic> topics,
                        const BagOptions& options, bool with_color) {
  const Chooser chooser(bag, topics);
  BagTopics chosen;
  if (options.clouds)
    chosen.clouds = choose_clouds(chooser, options);
  else
    chosen = choose_camera_topics(bag, topics, options, with_color);
  choose_joints(chooser, options, chosen);
  choose_transforms(chooser, chosen);
  chosen.poses = choose_poses(chooser, options, chosen);
  for (const auto& [type, name] : {std::pair(scene_type, "monitored_planning_scene"),
                                   std::pair(attached_type, "attached_collision_object")})
    if (auto found = usual(chooser, "attached", type, name,
                           "only recordings of one planning scene can be read"))
      chosen.attached.push_back(std::move(*found));
  for (const std::string& name : options.plan_topics)
    chosen.plans.push_back(
        chooser.named("planned motions", "--plan-topic", name, std::array{motion_type, plan_type}));
  if (options.plan_topics.empty())
    if (auto found = usual(chooser, "planned motions", plan_type, "display_planned_path",
                           "choose one with --plan-topic"))
      chosen.plans.push_back(std::move(*found));
  for (const std::string& name : options.target_topics)
    chosen.targets.push_back(
        chooser.named("targets", "--target-topic", name,
                      TopicTypes(target_types).subspan(options.clouds ? 2 : 0)));
  if (options.robot) return chosen;
  chosen.descriptions = of_robots(chooser, options, "robot", "robot_description", text_type);
  if (!chosen.descriptions.empty()) return chosen;
  auto description = usual(chooser, "robot", text_type, "robot_description",
                           "give the URDF with --robot, or --robot-namespace for each of several");
  if (!description)
    chooser.refuse("has no robot_description (std_msgs/msg/String); give the URDF with --robot");
  chosen.descriptions.push_back(std::move(*description));
  return chosen;
}

}  // namespace penumbra::io
