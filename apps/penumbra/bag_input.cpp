// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/run_input.hpp>
#include <io/bag_frames/bag_scene.hpp>
#include <io/bag_frames/bag_source.hpp>
#include <io/bag_frames/bag_topics.hpp>
#include <io/names.hpp>
#include <io/pose_file.hpp>
#include <io/printable.hpp>
#include <io/ros/camera_info_message.hpp>

namespace penumbra::app {
namespace {

constexpr double bag_target_history = 0.5;  // seconds by which detectors may be late

io::TopicWishes wishes_of(const RunArguments& arguments) {
  const BagArguments& bag = arguments.bag;
  return {.depth = bag.depth_topic,
          .camera_info = bag.camera_info_topic,
          .color = bag.color_topic,
          .joints = bag.joint_topics,
          .targets = bag.target_topics,
          .poses = bag.poses,
          .with_color = arguments.saves.overlay,
          .needs_description = !bag.robot,
          .needs_transforms = !bag.pose};
}

void tell_topics(const io::BagTopics& topics, bool with_color) {
  for (const io::TopicUse& use : topics.all())
    std::cout << use.role << ": " << io::printable(use.name) << " (" << use.type << "), " << use.why
              << '\n';
  if (with_color && !topics.color)
    std::cout << "color: no images are called color; overlays show depth\n";
  std::cout << "poses: from " << to_string(topics.poses) << '\n';
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

/// Where the camera sits.
struct Mount {
  std::string frame;   ///< the judged images' in TF; empty: the camera's pose is the pipeline's own
  std::string parent;  ///< link
  Eigen::Isometry3d T_parent_camera = Eigen::Isometry3d::Identity();
  std::string told;  ///< in words
};

void check_link(const Robot& robot, const std::string& option, const std::string& link) {
  if (robot.find_link(link)) return;
  const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
  throw InputError(option + ": '" + link + "' is no link of the robot" +
                   io::near_names(link, known));
}

/// The first of the frames from `frame` upwards that is a link; empty: none.
std::string link_above(const io::BagScene& scene, const Robot& robot, const std::string& frame) {
  for (const std::string& at : scene.chain(frame))
    if (robot.find_link(at)) return at;
  return {};
}

[[noreturn]] void refuse_mount(const RunArguments& arguments, const io::BagScene& scene,
                               const std::string& frame) {
  std::string known;
  if (!scene.parents.contains(frame)) known = ", which tf does not know";
  throw InputError(arguments.input.string() +
                   ": tf does not say where the camera is: no link of the robot is above its "
                   "frame '" +
                   io::printable(frame) + "'" + known +
                   "; name the frame with --camera-frame, or give --pose and --parent");
}

Mount find_mount(const RunArguments& arguments, io::BagSceneReader& reader, const Robot& robot,
                 const std::string& frame_of_images) {
  const BagArguments& bag = arguments.bag;
  if (bag.parent) check_link(robot, "--parent", *bag.parent);
  const std::string frame(io::frame_name(bag.camera_frame.value_or(frame_of_images)));
  if (bag.pose)
    return {"", bag.parent.value_or(robot.links().front()), io::read_pose_csv(*bag.pose),
            "--pose " + bag.pose->string()};
  if (frame.empty())
    throw InputError(arguments.input.string() +
                     ": the images do not name their frame; give it with --camera-frame");
  if (robot.find_link(frame) && !bag.parent)
    return {"", frame, Eigen::Isometry3d::Identity(), "a link of the robot"};
  std::string parent = bag.parent.value_or("");
  if (!bag.parent && reader.read_until([&](const io::BagScene& scene) {
        return !link_above(scene, robot, frame).empty();
      }))
    parent = link_above(reader.scene(), robot, frame);
  // Beside the robot, below a frame that both hang from.
  const std::string& root = robot.links().front();
  if (parent.empty() && reader.scene().connects(frame, root)) parent = root;
  if (parent.empty()) refuse_mount(arguments, reader.scene(), frame);
  return {frame, parent, Eigen::Isometry3d::Identity(), "tf"};
}

/// Whether images are free of distortion already, as the option or their name says.
bool is_rectified(const RunArguments& arguments, const std::string& topic) {
  return arguments.bag.rectified || io::is_called_rectified(topic);
}

Camera camera_of(const RunArguments& arguments, const io::CameraInfoMessage& info,
                 const io::TopicUse& use, const std::string& images) {
  return io::camera_of(info, arguments.input.string() + ": " + use.name,
                       is_rectified(arguments, images));
}

void check_frames(const RunArguments& arguments, const io::BagTopics& topics,
                  const io::BagScene& scene) {
  const std::string& depth = *scene.depth_frame;
  const std::string& info = scene.camera_info->header.frame_id;
  if (arguments.bag.camera_info_topic || io::frame_name(depth) == io::frame_name(info)) return;
  throw InputError(arguments.input.string() + ": " + topics.camera_info.name +
                   " is of the frame '" + io::printable(info) + "', the images of " +
                   topics.depth.name + " of '" + io::printable(depth) +
                   "'; say which camera_info is theirs with --camera-info-topic");
}

/// The cameras of a bag: that of the judged images, and the depth images' own if it is another.
struct Cameras {
  Camera judged;
  std::optional<Camera> depth;
};

Cameras cameras_of(const RunArguments& arguments, const io::BagTopics& topics,
                   const io::BagScene& scene) {
  Camera depth = camera_of(arguments, *scene.camera_info, topics.camera_info, topics.depth.name);
  depth.frame_id = *scene.depth_frame;
  if (!topics.color_info) return {std::move(depth), std::nullopt};
  Camera color = camera_of(arguments, *scene.color_info, *topics.color_info, topics.color->name);
  if (io::frame_name(color.frame_id) == io::frame_name(depth.frame_id))
    return {std::move(depth), std::nullopt};
  return {std::move(color), std::move(depth)};
}

}  // namespace

RunInput open_bag_input(const RunArguments& arguments) {
  io::BagSceneReader reader(arguments.input, wishes_of(arguments));
  tell_topics(reader.topics(), arguments.saves.overlay);
  reader.read_robot_and_camera();
  check_frames(arguments, reader.topics(), reader.scene());
  Cameras cameras = cameras_of(arguments, reader.topics(), reader.scene());
  RobotOptions options;
  options.packages = arguments.bag.packages;
  add_robot_choices(arguments, options);
  Robot robot = load_robot(arguments, reader, options);
  const Mount mount = find_mount(arguments, reader, robot, cameras.judged.frame_id);
  std::cout << "camera: frame '" << io::printable(cameras.judged.frame_id) << "' on link '"
            << mount.parent << "', by " << mount.told << '\n';
  if (cameras.depth)
    reader.read_until([&](const io::BagScene& scene) {
      return scene.connects(cameras.judged.frame_id, cameras.depth->frame_id);
    });

  io::BagSourceOptions source{.topics = reader.topics(),
                              .scene = reader.scene(),
                              .camera = cameras.judged,
                              .depth_camera = cameras.depth,
                              .poses = {.source = reader.topics().poses,
                                        .camera_parent = mount.parent,
                                        .camera_frame = mount.frame},
                              .time_offset = arguments.bag.time_offset,
                              .first = arguments.frames.first,
                              .end = arguments.frames.end,
                              .with_color = arguments.saves.overlay};
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
          .target_history = arguments.bag.target_topics.empty() ? 0.0 : bag_target_history,
          .frames = [source = std::move(source), input = arguments.input](
                        const Robot& loaded) -> std::unique_ptr<io::FrameSource> {
            return std::make_unique<io::BagSource>(input, loaded, source);
          }};
}

}  // namespace penumbra::app
