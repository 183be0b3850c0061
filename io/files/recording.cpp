// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/primitives.hpp>

#include <io/files/camera_info.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/names.hpp>
#include <io/files/recording.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_robots = 100, most_extra = 1000;

std::filesystem::path file_of(const YamlNode& node, const std::filesystem::path& folder) {
  std::filesystem::path file = folder / node.text();
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    node.fail(file.string() + " is a folder; name a file inside it");
  if (!std::filesystem::is_regular_file(file, error)) node.fail("no file " + file.string());
  return file;
}

Geometry geometry_of(const YamlNode& node) {
  if (node.text() == "collision") return Geometry::collision;
  if (node.text() == "visual") return Geometry::visual;
  node.fail("is '" + node.text() + "'; expected collision or visual");
}

std::map<std::string, std::filesystem::path> packages_of(const YamlNode& node,
                                                         const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path> packages;
  for (const YamlNode& package : node.entries()) {
    const std::filesystem::path at = folder / package.text();
    std::error_code error;
    if (!std::filesystem::is_directory(at, error)) package.fail("no folder " + at.string());
    packages.emplace(package.key(), at);
  }
  return packages;
}

RobotOptions robot_options_of(const YamlNode& robot, const std::filesystem::path& folder) {
  RobotOptions options;
  if (const YamlNode* packages = robot.find("packages"))
    options.packages = packages_of(*packages, folder);
  if (const YamlNode* arguments = robot.find("arguments"))
    for (const YamlNode& argument : arguments->entries())
      options.arguments.emplace(argument.key(), argument.text());
  if (const YamlNode* geometry = robot.find("geometry")) {
    if (!geometry->is_map())
      options.geometry = geometry_of(*geometry);
    else
      for (const YamlNode& link : geometry->entries())
        options.geometry_of_links.emplace(link.key(), geometry_of(link));
  }
  if (const YamlNode* links = robot.find("ignore_links")) options.ignore_links = links->texts();
  if (const YamlNode* links = robot.find("only_links")) options.only_links = links->texts();
  if (const YamlNode* joints = robot.find("joints"))
    for (const YamlNode& joint : joints->entries())
      options.joints.emplace(joint.key(), joint.number());
  if (const YamlNode* margins = robot.find("margins"))
    for (const YamlNode& link : margins->entries())
      options.margins.emplace(link.key(), link.number());
  const YamlNode* const extras = robot.find("extra");
  if (extras == nullptr) return options;
  if (extras->items().size() > most_extra)
    extras->fail("are more than " + std::to_string(most_extra));
  for (const YamlNode& extra : extras->items()) {
    extra.allow_only({"link", "mesh"});
    options.extra.push_back({extra.at("link").text(), file_of(extra.at("mesh"), folder)});
  }
  return options;
}

RecordedRobot robot_of(const YamlNode& robot, const std::filesystem::path& folder) {
  robot.allow_only({"urdf", "packages", "arguments", "geometry", "ignore_links", "only_links",
                    "margins", "joints", "extra", "pose"});
  return {.name = {},
          .urdf = file_of(robot.at("urdf"), folder),
          .options = robot_options_of(robot, folder)};
}

std::vector<RecordedRobot> robots_of(const YamlNode& root, const std::filesystem::path& folder) {
  const YamlNode* const several = root.find("robots");
  if (several == nullptr) {
    const YamlNode& only = root.at("robot");
    if (const YamlNode* pose = only.find("pose"))
      pose->fail("is for several robots ('robots: NAME: ...'); leave it out");
    return {robot_of(only, folder)};
  }
  if (root.find("robot") != nullptr) several->fail("stands beside 'robot'; expected one of them");
  std::vector<RecordedRobot> robots;
  if (several->entries().size() > most_robots)
    several->fail("are more than " + std::to_string(most_robots));
  for (const YamlNode& entry : several->entries()) {
    entry.with_context([&] { check_name(entry.key()); });
    RecordedRobot& robot = robots.emplace_back(robot_of(entry, folder));
    robot.name = entry.key();
    const YamlNode& pose = entry.at("pose");
    const std::vector<double> numbers = pose.numbers(7);
    robot.T_world_root = pose.with_context([&] { return isometry_of(numbers); });
  }
  return robots;
}

/// Reads the depth camera, if it is another one than the camera.
void read_depth_camera(const YamlNode& node, const std::filesystem::path& folder,
                       RecordingCamera& camera) {
  const YamlNode* const info = node.find("depth_info");
  if (info == nullptr && node.find("depth_pose") == nullptr) return;
  camera.depth = read_camera_info(file_of(node.at("depth_info"), folder), false);
  camera.depth->range = camera.camera.range;
  camera.T_camera_depth = read_pose_csv(file_of(node.at("depth_pose"), folder));
}

/// Refuses unknown keys. `more`: keys of one of several cameras.
RuleOptions rule_of(const YamlNode& node, const std::vector<std::string_view>& more) {
  std::vector<std::string_view> camera_keys{"info",       "parent",      "pose",       "sensor",
                                            "range",      "rectified",   "beyond",     "depth_info",
                                            "depth_pose", "depth_scale", "depth_along"};
  camera_keys.insert(camera_keys.end(), more.begin(), more.end());
  RuleOptions rule;
  rule.given = read_settings(node, rule.values, std::move(camera_keys));
  if (const YamlNode* sensor = node.find("sensor")) {
    rule.sensor = sensor->text();
    sensor->with_context([&] { return LabelRule::for_sensor(sensor->text()); });
  }
  return rule;
}

void read_depth_meaning(const YamlNode& node, RecordingCamera& camera) {
  if (const YamlNode* range = node.find("range")) {
    const std::vector<double> ends = range->numbers(2);
    camera.range = camera.camera.range = {ends[0], ends[1]};
    range->with_context([&] { camera.camera.check(); });
  }
  if (const YamlNode* along = node.find("depth_along")) {
    camera.depth_along_ray = along->text() == "ray";
    if (!camera.depth_along_ray && along->text() != "z")
      along->fail("is '" + along->text() + "'; expected z or ray");
  }
  if (const YamlNode* beyond = node.find("beyond")) {
    if (beyond->text() == "occluded")
      camera.beyond = BeyondMeans::occluded;
    else if (beyond->text() == "visible")
      camera.beyond = BeyondMeans::visible;
    else
      beyond->fail("is '" + beyond->text() + "'; expected occluded or visible");
  }
}

RecordingCamera camera_of(const YamlNode& node, const std::vector<std::string_view>& more,
                          const std::filesystem::path& folder) {
  RuleOptions rule = rule_of(node, more);
  const YamlNode* rectified = node.find("rectified");
  const bool is_rectified = rectified != nullptr && rectified->boolean();
  const std::filesystem::path info = file_of(node.at("info"), folder);
  RecordingCamera camera{.info = info,
                         .camera = read_camera_info(info, is_rectified),
                         .rectified = is_rectified,
                         .rule = std::move(rule)};
  const YamlNode* pose = node.find("pose");
  if (pose != nullptr || node.find("parent") != nullptr)
    camera.camera.parent = node.at("parent").text();
  if (pose != nullptr) {
    camera.pose = file_of(*pose, folder);
    camera.camera.T_parent_camera = read_pose_csv(camera.pose);
  }
  if (const YamlNode* scale = node.find("depth_scale")) {
    camera.depth_scale = scale->number();
    if (!(*camera.depth_scale > 0.0))
      scale->fail("is not above 0; expected metres per unit of the depth images, as in 0.0001");
  }
  read_depth_meaning(node, camera);
  read_depth_camera(node, folder, camera);
  return camera;
}

FramePattern pattern_of(const YamlNode& node, const std::filesystem::path& folder,
                        const std::filesystem::path& joints) {
  std::optional<FrameStamps> stamps;
  if (node.text().find("%t") != std::string::npos) stamps = read_frame_stamps(joints);
  FramePattern pattern =
      node.with_context([&] { return FramePattern(node.text(), folder, stamps); });
  if (!pattern.fault().empty()) node.fail(pattern.fault());
  return pattern;
}

/// `images` has the patterns; of several cameras, one may have joints at its own stamps.
RecordingFrames frames_of(const YamlNode& node, const YamlNode& images,
                          const std::filesystem::path& folder) {
  const YamlNode* const joints = images.find("joints");
  RecordingFrames frames{file_of(joints != nullptr ? *joints : node.at("joints"), folder),
                         std::nullopt, std::nullopt};
  if (const YamlNode* depth = images.find("depth"))
    frames.depth = pattern_of(*depth, folder, frames.joints);
  if (const YamlNode* color = images.find("color"))
    frames.color = pattern_of(*color, folder, frames.joints);
  return frames;
}

std::vector<std::string> names_of(const YamlNode& cameras) {
  std::vector<std::string> names;
  for (const YamlNode& camera : cameras.entries()) {
    const std::string& name = names.emplace_back(camera.key());
    camera.with_context([&] { check_camera_name(name); });
  }
  if (names.empty()) cameras.fail("names no camera");
  return names;
}

/// Returns the wanted one of several cameras; null if the recording has one only.
const YamlNode* wanted_camera(const YamlNode& root, const std::string& wanted) {
  const YamlNode* const cameras = root.find("cameras");
  const YamlNode& frames = root.at("frames");
  if (const YamlNode* clouds = frames.find("cloud"))
    clouds->fail("is for `penumbra cloud`; all other commands take images");
  root.allow_only({"robot", "robots", cameras != nullptr ? "cameras" : "camera", "frames",
                   "targets", "attached"});
  if (cameras == nullptr) {
    frames.allow_only({"joints", "depth", "color"});
    if (!wanted.empty())
      root.at("camera").fail("the recording has one camera, without a name; leave '" + wanted +
                             "' out");
    return nullptr;
  }
  frames.allow_only({"joints"});
  std::string known;
  for (const std::string& name : names_of(*cameras)) known += (known.empty() ? "" : ", ") + name;
  const YamlNode* const camera = wanted.empty() ? nullptr : cameras->find(wanted);
  if (camera == nullptr)
    cameras->fail((wanted.empty() ? "the recording has several; choose one by --camera"
                                  : "there is no '" + wanted + "'") +
                  ": " + known);
  return camera;
}

std::filesystem::path yaml_of(const std::filesystem::path& folder_or_yaml) {
  std::error_code error;
  return std::filesystem::is_directory(folder_or_yaml, error) ? folder_or_yaml / "recording.yaml"
                                                              : folder_or_yaml;
}

std::shared_ptr<const PreparedMesh> mesh_of(const YamlNode& body,
                                            const std::filesystem::path& folder) {
  const YamlNode* const box = body.find("box");
  const YamlNode* const file = body.find("mesh");
  if ((box == nullptr) == (file == nullptr)) body.fail("needs a mesh (a file) or a box (its size)");
  if (file != nullptr) return std::make_shared<PreparedMesh>(load_mesh(file_of(*file, folder)));
  const std::vector<double> size = box->numbers(3);
  return std::make_shared<PreparedMesh>(box->with_context([&] {
    return make_box({size[0], size[1], size[2]});
  }));
}

std::vector<RecordedBody> bodies_of(const YamlNode& attached, const std::filesystem::path& folder) {
  std::vector<RecordedBody> bodies;
  for (const YamlNode& entry : attached.items()) {
    entry.allow_only({"name", "link", "mesh", "box", "pose", "frames"});
    RecordedBody& body =
        bodies.emplace_back(RecordedBody{.body = {.name = entry.at("name").text(),
                                                  .link = entry.at("link").text(),
                                                  .mesh = mesh_of(entry, folder)},
                                         .first = 0,
                                         .end = std::numeric_limits<std::int64_t>::max()});
    if (const YamlNode* pose = entry.find("pose")) {
      const std::vector<double> numbers = pose->numbers(7);
      body.body.T_link_body = pose->with_context([&] { return isometry_of(numbers); });
    }
    if (const YamlNode* frames = entry.find("frames")) {
      if (frames->items().size() != 2) frames->fail("expected [FIRST, END]");
      body.first = frames->items()[0].integer();
      body.end = frames->items()[1].integer();
      if (body.first >= body.end) frames->fail("hold no frame; expected FIRST below END");
    }
    entry.with_context([&] { check_name(body.body.name); });
    for (const RecordedBody& other : std::span(bodies).first(bodies.size() - 1))
      if (other.body.name == body.body.name && other.first < body.end && body.first < other.end)
        entry.fail("another body has this name in the same frames");
  }
  return bodies;
}

}  // namespace

std::vector<std::string> Recording::cameras(const std::filesystem::path& folder_or_yaml) {
  const YamlNode root = YamlNode::read(yaml_of(folder_or_yaml));
  const YamlNode* const cameras = root.find("cameras");
  return cameras != nullptr ? names_of(*cameras) : std::vector<std::string>();
}

Recording Recording::open(const std::filesystem::path& folder_or_yaml, const std::string& camera) {
  const std::filesystem::path file = yaml_of(folder_or_yaml);
  const std::filesystem::path folder = file.parent_path();
  const YamlNode root = YamlNode::read(file);
  const YamlNode* const one = wanted_camera(root, camera);
  std::optional<std::filesystem::path> targets;
  if (const YamlNode* named = root.find("targets")) targets = file_of(*named, folder);
  if (const YamlNode* own = one != nullptr ? one->find("targets") : nullptr)
    targets = file_of(*own, folder);
  std::vector<RecordedBody> attached;
  if (const YamlNode* bodies = root.find("attached")) attached = bodies_of(*bodies, folder);
  return {.file = file,
          .robots = robots_of(root, folder),
          .camera = one != nullptr
                        ? camera_of(*one, {"joints", "depth", "color", "targets"}, folder)
                        : camera_of(root.at("camera"), {}, folder),
          .frames = frames_of(root.at("frames"), one != nullptr ? *one : root.at("frames"), folder),
          .targets = targets,
          .attached = std::move(attached)};
}

std::optional<CloudRecording> CloudRecording::open(const std::filesystem::path& folder_or_yaml) {
  const std::filesystem::path file = yaml_of(folder_or_yaml);
  const std::filesystem::path folder = file.parent_path();
  const YamlNode root = YamlNode::read(file);
  const YamlNode& frames = root.at("frames");
  const YamlNode* const clouds = frames.find("cloud");
  if (clouds == nullptr) return std::nullopt;
  root.allow_only({"robot", "robots", "sensor", "frames", "targets", "attached"});
  frames.allow_only({"joints", "cloud"});
  const YamlNode& sensor = root.at("sensor");
  const std::filesystem::path joints = file_of(frames.at("joints"), folder);
  CloudRecording recording{.file = file,
                           .robots = robots_of(root, folder),
                           .parent = {},
                           .pose = {},
                           .rule = {},
                           .joints = joints,
                           .clouds = pattern_of(*clouds, folder, joints),
                           .targets = {},
                           .attached = {}};
  if (const YamlNode* model = sensor.find("model"))
    recording.rule = model->with_context([&] { return CloudRule::for_sensor(model->text()); });
  read_settings(sensor, recording.rule, {"model", "parent", "pose", "merged"});
  if (const YamlNode* parent = sensor.find("parent")) recording.parent = parent->text();
  if (const YamlNode* pose = sensor.find("pose")) {
    recording.pose = file_of(*pose, folder);
    recording.T_parent_sensor = read_pose_csv(recording.pose);
  }
  if (const YamlNode* merged = sensor.find("merged")) recording.has_rays = !merged->boolean();
  if (recording.has_rays && recording.parent.empty() && recording.pose.empty())
    sensor.fail("says neither by parent nor by pose where the sensor is");
  if (const YamlNode* named = root.find("targets")) recording.targets = file_of(*named, folder);
  if (const YamlNode* bodies = root.find("attached"))
    recording.attached = bodies_of(*bodies, folder);
  return recording;
}

std::vector<std::string> patterns_of(const std::vector<std::string>& patterns,
                                     const std::string& robot) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  std::vector<std::string> own;
  for (const std::string& pattern : patterns)
    if (pattern.starts_with(prefix)) own.push_back(pattern.substr(prefix.size()));
  return own;
}

std::vector<ExtraMesh> extra_of(const std::vector<ExtraMesh>& extra, const std::string& robot) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  std::vector<ExtraMesh> own;
  for (const ExtraMesh& part : extra)
    if (part.link.starts_with(prefix)) own.push_back({part.link.substr(prefix.size()), part.mesh});
  return own;
}

void check_robots_of(const std::map<std::string, double>& joints,
                     std::span<const std::string> robots) {
  for (const auto& [joint, position] : joints)
    if (std::ranges::none_of(robots, [&name = joint](const std::string& robot) {
          return robot.empty() || name.starts_with(robot + "/");
        }))
      throw InputError("joint '" + joint + "' names no robot; expected " + robots.front() + "/" +
                       joint);
}

std::map<std::string, double> joints_of(const std::map<std::string, double>& joints,
                                        const std::string& robot) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  std::map<std::string, double> own;
  for (const auto& [joint, position] : joints)
    if (joint.starts_with(prefix)) own.emplace(joint.substr(prefix.size()), position);
  return own;
}

Robot load_robot(const std::vector<RecordedRobot>& robots) {
  if (robots.size() == 1 && robots.front().name.empty())
    return Robot::load(robots.front().urdf, robots.front().options);
  std::vector<PlacedRobot> all;
  for (const RecordedRobot& robot : robots)
    all.push_back({robot.name, Robot::load(robot.urdf, robot.options), robot.T_world_root});
  return Robot::join(all);
}

RobotOptions Recording::robot_options() const {
  RobotOptions all = robots.front().options;
  if (robots.front().name.empty()) return all;
  all = {.geometry = all.geometry, .geometry_fallback = all.geometry_fallback};
  for (const auto& [name, urdf, options, pose] : robots) {
    const std::string prefix = name + "/";
    for (const auto& [link, geometry] : options.geometry_of_links)
      all.geometry_of_links.emplace(prefix + link, geometry);
    if (options.geometry != all.geometry)
      all.geometry_of_links.emplace(prefix + "*", options.geometry.value_or(Geometry::collision));
    for (const auto& [link, margin] : options.margins) all.margins.emplace(prefix + link, margin);
    for (const auto& link : options.ignore_links) all.ignore_links.push_back(prefix + link);
    for (const auto& link : options.only_links) all.only_links.push_back(prefix + link);
    for (const auto& [joint, at] : options.joints) all.joints.emplace(prefix + joint, at);
    for (const auto& extra : options.extra) all.extra.push_back({prefix + extra.link, extra.mesh});
  }
  return all;
}

PipelineConfig Recording::pipeline_config() const {
  if (!camera.camera.T_parent_camera)
    throw InputError(file.string() +
                     ": camera: key 'pose' is missing; 'penumbra calibrate --search' finds it");
  PipelineConfig config;
  config.has_depth = frames.depth.has_value();
  config.rule = camera.rule.applied_to(config.rule);
  return config;
}

}  // namespace penumbra::io
