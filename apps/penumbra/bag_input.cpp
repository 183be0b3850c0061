// SPDX-License-Identifier: Apache-2.0
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/run_input.hpp>
#include <io/assembly/bag_scene.hpp>
#include <io/assembly/bag_source.hpp>
#include <io/assembly/bag_topics.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/printable.hpp>

namespace penumbra::app {
namespace {

io::TopicOptions topic_options(const RunArguments& arguments) {
  const BagArguments& bag = arguments.bag;
  return {.depth = bag.depth_topic,
          .camera_info = bag.camera_info_topic,
          .color = bag.color_topic,
          .joints = bag.joint_topics,
          .targets = bag.target_topics,
          .poses = bag.poses,
          .with_color = arguments.needs_color(),
          .needs_description = !bag.robot,
          .needs_transforms = !bag.pose};
}

void tell_topics(const io::BagTopics& topics, bool with_color, std::ostream& told) {
  for (const io::TopicUse& use : topics.all())
    told << use.role << ": " << io::printable(use.name) << " (" << use.type << "), " << use.why
         << '\n';
  if (with_color && !topics.color)
    told << "color: no images are called color; overlays show depth\n";
  told << "poses: from " << to_string(topics.poses) << '\n';
}

Robot load_robot(const RunArguments& arguments, const io::BagSceneReader& reader,
                 const RobotOptions& options) {
  if (arguments.bag.robot) return Robot::load(*arguments.bag.robot, options);
  try {
    return Robot::parse(*reader.scene().description, arguments.input.parent_path(), options);
  } catch (const InputError& error) {
    throw InputError(arguments.input.string() + ": " + error.what());
  }
}

[[noreturn]] void refuse_mount(const RunArguments& arguments, const io::BagScene& scene,
                               const std::string& frame) {
  std::string known;
  if (!scene.frames.has_parent(frame)) known = ", which tf does not know";
  throw InputError(arguments.input.string() +
                   ": tf does not say where the camera is: no link of the robot is above its "
                   "frame '" +
                   io::printable(frame) + "'" + known +
                   "; name the frame with --camera-frame, or give --pose and --parent");
}

io::CameraMount find_mount(const RunArguments& arguments, io::BagSceneReader& reader,
                           const Robot& robot, const std::string& frame_of_images) {
  const io::MountOptions options = mount_options(arguments.bag);
  if (!options.pose && io::mounted_frame(options, frame_of_images).empty())
    throw InputError(arguments.input.string() +
                     ": the images do not name their frame; give it with --camera-frame");
  std::optional<io::CameraMount> mount;
  reader.read_until([&](const io::BagScene& scene) {
    mount = io::find_mount(robot, options, scene.frames, frame_of_images);
    return mount.has_value();
  });
  if (mount) return *mount;
  // Beside the robot, below a frame that both hang from.
  const std::string frame = io::mounted_frame(options, frame_of_images);
  if (!reader.scene().frames.connects(frame, options.frame_prefix + robot.links().front()))
    refuse_mount(arguments, reader.scene(), frame);
  return io::mount_by_root(robot, options, frame_of_images);
}

io::JudgedCameras cameras_of(const RunArguments& arguments, const io::BagTopics& topics,
                             const io::BagScene& scene) {
  io::CameraEvidence evidence{
      .source = arguments.input.string(),
      .depth = {*scene.camera_info, topics.camera_info.name, topics.depth.name},
      .color = {},
      .depth_frame = *scene.depth_frame,
      .info_is_named = arguments.bag.camera_info_topic.has_value(),
      .is_rectified = arguments.bag.rectified};
  if (topics.color_info)
    evidence.color.emplace(
        io::InfoOfImages{*scene.color_info, topics.color_info->name, topics.color->name});
  return io::judged_cameras(evidence);
}

io::UsedBag used_bag(const RunArguments& arguments, const io::BagTopics& topics,
                     const io::CameraMount& mount, const std::string& frame) {
  io::UsedBag used{.topics = {},
                   .poses = std::string(to_string(topics.poses)),
                   .camera_frame = frame,
                   .camera_link = mount.parent,
                   .camera_by = mount.source,
                   .time_offset = arguments.bag.time_offset,
                   .first_publisher = arguments.bag.first_publisher};
  for (const io::TopicUse& use : topics.all())
    used.topics.push_back({use.role, use.name, use.type, use.why});
  return used;
}

}  // namespace

io::MountOptions mount_options(const BagArguments& bag) {
  io::MountOptions options{.camera_frame = bag.camera_frame,
                           .parent = bag.parent,
                           .pose = {},
                           .frame_prefix = bag.frame_prefix};
  if (!bag.pose) return options;
  options.pose = io::read_pose_csv(*bag.pose);
  options.pose_source = "--pose " + bag.pose->string();
  return options;
}

RunInput open_bag_input(const RunArguments& arguments, std::ostream& told) {
  io::BagSceneReader reader(arguments.input, topic_options(arguments));
  tell_topics(reader.topics(), arguments.needs_color(), told);
  reader.read_robot_and_camera();
  io::JudgedCameras cameras = cameras_of(arguments, reader.topics(), reader.scene());
  RobotOptions options;
  options.packages = arguments.bag.packages;
  add_robot_choices(arguments, options);
  Robot robot = load_robot(arguments, reader, options);
  const io::CameraMount mount = find_mount(arguments, reader, robot, cameras.judged.frame_id);
  told << "camera: frame '" << io::printable(cameras.judged.frame_id) << "' on link '"
       << mount.parent << "', by " << mount.source << '\n';
  if (cameras.depth)
    reader.read_until([&](const io::BagScene& scene) {
      return scene.frames.connects(cameras.judged.frame_id, cameras.depth->frame_id);
    });

  io::BagSourceOptions source{.topics = reader.topics(),
                              .scene = reader.scene(),
                              .camera = cameras.judged,
                              .depth_camera = cameras.depth,
                              .poses = {.source = reader.topics().poses,
                                        .frame_prefix = arguments.bag.frame_prefix,
                                        .camera_parent = mount.parent,
                                        .camera_frame = mount.frame},
                              .compare_sources = !arguments.bag.first_publisher,
                              .time_offset = arguments.bag.time_offset,
                              .first = arguments.frames.first,
                              .end = arguments.frames.end,
                              .with_color = arguments.needs_color()};
  io::UsedBag used = used_bag(arguments, reader.topics(), mount, cameras.judged.frame_id);
  PipelineConfig config;
  config.camera_parent = mount.parent;
  config.T_parent_camera = mount.T_parent_camera;
  return {.robot_options = options,
          .robot = std::move(robot),
          .camera = std::move(cameras.judged),
          .camera_info = arguments.input.string() + ": " + reader.topics().camera_info.name,
          .config = std::move(config),
          .beyond = {},
          .targets = {},
          .target_history = arguments.bag.target_topics.empty() ? 0.0 : topic_target_history,
          .bag = std::move(used),
          .frames = [source = std::move(source), input = arguments.input](
                        const Robot& loaded) -> std::unique_ptr<io::FrameSource> {
            return std::make_unique<io::BagSource>(input, loaded, source);
          }};
}

}  // namespace penumbra::app
