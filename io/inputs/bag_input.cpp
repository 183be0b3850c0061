// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_scene.hpp>
#include <io/assembly/bag_source.hpp>
#include <io/assembly/bag_topics.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/files/printable.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::io {
namespace {

void print_topics(const BagTopics& topics, bool with_color, const LineSink& print) {
  for (const TopicUse& use : topics.all())
    print(use.role + ": " + printable(use.name) + " (" + use.type + "), " + use.why);
  if (with_color && topics.has_depth && !topics.color)
    print("color: no images are called color; overlays show depth");
  print("poses: from " + std::string(to_string(topics.poses)));
}

Robot load_robot(const InputOptions& options, const BagSceneReader& reader,
                 const RobotOptions& robot) {
  if (options.bag.robot) return Robot::load(*options.bag.robot, robot);
  try {
    return robot_of(reader.scene().descriptions, reader.scene().static_transforms,
                    options.path.parent_path(), robot);
  } catch (const InputError& error) {
    throw InputError(options.path.string() + ": " + error.what());
  }
}

[[noreturn]] void refuse_mount(const InputOptions& options, const BagSceneReader& reader,
                               const Robot& robot, const std::string& frame) {
  std::string known;
  const std::string prefix = likely_prefix(robot, reader.scene().frames, frame);
  if (!prefix.empty() && prefix != options.bag.frame_prefix)
    throw InputError(options.path.string() + ": in tf '" + printable(prefix) +
                     "' stands before the links' names: give --frame-prefix " + printable(prefix));
  if (reader.topics().transforms.empty())
    known = ": the bag has no tf";
  else if (!reader.scene().frames.has_parent(frame))
    known = ", which tf does not know";
  const bool clouds = options.bag.clouds;
  throw InputError(
      options.path.string() + ": tf does not say where the " + (clouds ? "sensor" : "camera") +
      " is: no link of the robot is above its frame '" + printable(frame) + "'" + known + "; " +
      (clouds ? "choose other clouds with --topic" : "name the frame with --camera-frame") +
      ", or give --pose and --parent");
}

CameraMount mount_in_bag(const InputOptions& options, BagSceneReader& reader, const Robot& robot,
                         const std::string& frame_of_images) {
  MountOptions wanted = mount_options(options.bag);
  if (!options.needs_camera_pose && wanted.parent) wanted.pose = Eigen::Isometry3d::Identity();
  if (!wanted.pose && mounted_frame(wanted, frame_of_images).empty())
    throw InputError(options.path.string() +
                     (options.bag.clouds
                          ? ": the clouds do not name their frame; give --pose and --parent"
                          : ": the images do not name their frame; give it with --camera-frame"));
  const std::string frame = mounted_frame(wanted, frame_of_images);
  const std::string root = options.bag.frame_prefix + robot.links().front();
  std::optional<CameraMount> mount;
  reader.read_until([&](const BagScene& scene) {
    mount = find_mount(robot, wanted, scene.frames, frame_of_images);
    // Once the camera and the root link have a frame above both, no link can come above the camera.
    return mount || scene.frames.connects(frame, root);
  });
  if (mount) return *mount;
  if (!options.needs_camera_pose)
    return {"", robot.links().front(), Eigen::Isometry3d::Identity(), "nothing yet"};
  if (!reader.scene().frames.connects(frame, root)) refuse_mount(options, reader, robot, frame);
  return mount_by_root(robot, wanted, frame_of_images);
}

JudgedCameras cameras_of(const InputOptions& options, const BagTopics& topics,
                         const BagScene& scene) {
  CameraEvidence evidence{.source = options.path.string(),
                          .depth = {*scene.camera_info, topics.camera_info.name, topics.depth.name},
                          .color = {},
                          .depth_frame = *scene.depth_frame,
                          .info_is_named = options.bag.camera_info_topic.has_value(),
                          .is_rectified = options.bag.rectified};
  if (topics.color_info)
    evidence.color.emplace(
        InfoOfImages{*scene.color_info, topics.color_info->name, topics.color->name});
  JudgedCameras cameras = judged_cameras(evidence);
  cameras.has_depth = topics.has_depth;
  cameras.depth_scale = options.bag.depth_scale;
  cameras.depth_along_ray = options.bag.depth_along_ray;
  return cameras;
}

UsedBag used_bag(const InputOptions& options, const BagTopics& topics, const CameraMount& mount,
                 const std::string& frame) {
  UsedBag used{.topics = {},
               .poses = std::string(to_string(topics.poses)),
               .camera_frame = frame,
               .camera_link = mount.parent,
               .camera_by = mount.source,
               .time_offset = options.bag.time_offset,
               .first_publisher = options.bag.first_publisher,
               .joint_names = options.bag.joint_names,
               .depth_scale = options.bag.depth_scale,
               .depth_along_ray = options.bag.depth_along_ray};
  for (const TopicUse& use : topics.all())
    used.topics.push_back({use.role, use.name, use.type, use.why});
  return used;
}

BagSourceOptions source_options(const InputOptions& options, const BagSceneReader& reader) {
  return {.bag = options.bag,
          .topics = reader.topics(),
          .static_transforms = reader.scene().static_transforms,
          .first = options.frames.first,
          .end = options.frames.end,
          .range_option = options.frames.option,
          .with_color = options.with_color};
}

std::function<std::unique_ptr<FrameSource>()> source_of(const std::filesystem::path& bag,
                                                        const Robot& robot,
                                                        BagSourceOptions options) {
  return [bag, robot, options = std::move(options)] {
    return std::make_unique<BagSource>(bag, robot, options);
  };
}

}  // namespace

std::vector<RunInput> open_bag_clouds(const InputOptions& options, const CloudInputOptions& clouds,
                                      const LineSink& print) {
  BagSceneReader reader(options.path, options.bag, false);
  print_topics(reader.topics(), false, print);
  reader.read_robot_and_camera();
  RobotOptions robot_options;
  robot_options.packages = options.bag.packages;
  robot_options.arguments = options.bag.arguments;
  options.apply_to(robot_options);
  const Robot robot = load_robot(options, reader, robot_options);
  const bool is_of_one = options.bag.pose || options.bag.parent || clouds.is_in_other_frame();
  if (is_of_one && reader.topics().clouds.size() > 1)
    throw InputError(
        "--pose, --parent, --sensor-frame and --merged are for one sensor, and the bag has " +
        std::to_string(reader.topics().clouds.size()) +
        " topics of clouds; choose one with --topic");
  std::vector<RunInput> inputs;
  for (const TopicUse& use : reader.topics().clouds) {
    const std::string frame = reader.scene().cloud_frames.at(use.name);
    if (!clouds.is_in_other_frame() &&
        is_above_robot(robot, mount_options(options.bag), reader.scene().frames, frame))
      throw InputError(use.name + ": its clouds are given in frame '" + printable(frame) +
                       "', above the robot, and not in their sensor's: name that with "
                       "--sensor-frame, give --merged, or choose other clouds with --topic");
    const CameraMount mount = mount_in_bag(options, reader, robot, frame);
    print(use.name + ": frame '" + printable(frame) + "' on link '" + mount.parent + "', by " +
          mount.source);
    BagSourceOptions source = source_options(options, reader);
    source.cloud = clouds;
    source.cloud->topic = use.name;
    source.cloud->known = mount;
    source.cloud->known_frame = frame_name(frame);
    const double history = reader.topics().targets.empty() ? 0.0 : topic_target_history;
    inputs.push_back(
        {.robot_options = robot_options,
         .robot = robot,
         .camera_info = {},
         .config = {},
         .beyond = {},
         .targets = {},
         .target_history = history,
         .bag = used_bag(options, reader.topics(), mount, frame),
         .made_files = {},
         .frames = source_of(options.path, robot, std::move(source)),
         .cloud = {.rule = clouds.rule,
                   .threads = clouds.threads,
                   .sensor_parent = mount.parent,
                   .T_parent_sensor = mount.T_parent_camera,
                   .target_history = history},
         .used_clouds = {.rule = {}, .merged = !clouds.has_rays, .times = clouds.use_times},
         .sensor = use.name});
  }
  return inputs;
}

RunInput open_bag_input(const InputOptions& options, const LineSink& print) {
  BagSceneReader reader(options.path, options.bag, options.with_color);
  print_topics(reader.topics(), options.with_color, print);
  if (options.needs_depth && !reader.topics().has_depth)
    throw InputError(options.path.string() + ": --no-depth: " + needs_depth_images);
  reader.read_robot_and_camera();
  JudgedCameras cameras = cameras_of(options, reader.topics(), reader.scene());
  RobotOptions robot_options;
  robot_options.packages = options.bag.packages;
  robot_options.arguments = options.bag.arguments;
  options.apply_to(robot_options);
  const Robot robot = load_robot(options, reader, robot_options);
  const CameraMount mount = mount_in_bag(options, reader, robot, cameras.judged.frame_id);
  print("camera: frame '" + printable(cameras.judged.frame_id) + "' on link '" + mount.parent +
        "', by " + mount.source);
  if (cameras.depth)
    reader.read_until([&](const BagScene& scene) {
      return scene.frames.connects(cameras.judged.frame_id, cameras.depth->frame_id);
    });

  const BagScene& scene = reader.scene();
  BagSourceOptions source = source_options(options, reader);
  source.camera = KnownCamera{.info = *scene.camera_info,
                              .color_info = scene.color_info,
                              .depth_frame = *scene.depth_frame,
                              .cameras = cameras,
                              .mount = mount};
  UsedBag used = used_bag(options, reader.topics(), mount, cameras.judged.frame_id);
  std::vector<std::int64_t> numbers(reader.topics().depth.messages.value_or(0));
  std::iota(numbers.begin(), numbers.end(), 0);
  PipelineConfig config;
  config.has_depth = reader.topics().has_depth;
  cameras.judged.parent = mount.parent;
  cameras.judged.T_parent_camera = mount.T_parent_camera;
  return {.robot_options = std::move(robot_options),
          .robot = robot,
          .camera = std::move(cameras.judged),
          .camera_info = options.path.string() + ": " + reader.topics().camera_info.name,
          .config = std::move(config),
          .beyond = {},
          .targets = {},
          .frame_numbers = std::move(numbers),
          .target_history = options.bag.target_topics.empty() ? 0.0 : topic_target_history,
          .bag = std::move(used),
          .made_files = {},
          .frames = source_of(options.path, robot, std::move(source))};
}

}  // namespace penumbra::io
