// SPDX-License-Identifier: Apache-2.0
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/ros/image_codec.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/message_encoder.hpp>
#include <sim/recording_bag.hpp>

namespace penumbra::sim {
namespace {

namespace fs = std::filesystem;

/// Reliable, transient local, keep last 1, with rmw's numbers as rosbag2 stores them. The player
/// then offers these topics to late subscribers.
constexpr const char* latched_qos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

/// Returns the bag's name if nothing exists there. An existing file is refused, because its owner
/// is not known.
fs::path new_file(const fs::path& file) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(file, error)))
    throw InputError("--output: " + file.string() + " is there; choose another name");
  return file;
}

/// Returns whether `folder` has every file of `wanted`.
bool holds(const fs::path& folder, const fs::path& wanted) {
  for (const auto& entry : fs::recursive_directory_iterator(wanted)) {
    const fs::path file = folder / entry.path().lexically_relative(wanted);
    if (entry.is_regular_file() &&
        (!fs::is_regular_file(file) ||
         read_whole_file(entry.path(), FileLimit::data) != read_whole_file(file, FileLimit::data)))
      return false;
  }
  return true;
}

/// Returns the folder of the URDF's package next to a bag, where package://NAME/... is found.
/// Refuses a folder of that name with other content.
fs::path mesh_folder(const fs::path& description, const fs::path& bag) {
  fs::path folder = bag.parent_path() / description.filename();
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)) && !holds(folder, description))
    throw InputError("--output: " + folder.string() +
                     " is there and does not hold the simulated arm's meshes, which go there; "
                     "choose another folder for the bag");
  return folder;
}

io::CameraInfoMessage info_of(const Camera& camera, const io::MessageHeader& header) {
  const Intrinsics& k = camera.intrinsics;
  io::CameraInfoMessage info{.header = header,
                             .height = static_cast<std::uint32_t>(k.height()),
                             .width = static_cast<std::uint32_t>(k.width()),
                             .distortion_model = "plumb_bob",
                             .d = {0, 0, 0, 0, 0}};
  info.k = {k.fx(), 0, k.cx(), 0, k.fy(), k.cy(), 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {k.fx(), 0, k.cx(), 0, 0, k.fy(), k.cy(), 0, 0, 0, 1, 0};
  return info;
}

io::JointStateMessage joint_states(const Robot& robot, const io::MessageHeader& header,
                                   const std::vector<double>& positions) {
  const auto names = robot.variables();
  return {.header = header, .names = {names.begin(), names.end()}, .positions = positions};
}

/// Returns the second camera's frame. Both cameras of a simulation have the same frame name.
std::string second_frame(const Simulation& simulation) {
  return "second_" + simulation.camera().frame_id;
}

/// Returns the fields of an object that are known without judging it.
io::TargetMessage target_of(const ObjectTruth& object, std::int64_t stamp) {
  io::TargetMessage target{.name = object.name,
                           .has_stamp = true,
                           .stamp = stamp,
                           .reason = "the truth: pixels, no verdict",
                           .judged = true,
                           .inside = object.pixels_alone};
  if (object.pixels_alone == 0) return target;
  const auto all = static_cast<double>(object.pixels_alone);
  const auto others = object.pixels_alone - object.pixels_seen - object.pixels_behind_robot;
  target.occluded_fraction = static_cast<double>(object.pixels_behind_robot) / all;
  target.hidden_by_other_fraction = static_cast<double>(others) / all;
  return target;
}

}  // namespace

RecordingBag::RecordingBag(const fs::path& file, const Simulation& simulation,
                           const std::string& scene, const SimulationOptions& options)
    : file_(new_file(file)),
      meshes_(mesh_folder(simulation.urdf().parent_path(), file)),
      pending_(file),
      writer_(pending_.part(), {.profile = "ros2"}),
      simulation_(simulation),
      second_camera_(options.second_camera),
      root_(simulation.robot().links().front()),
      scene_(scene_text(simulation, scene, options)) {}

std::string RecordingBag::where() const {
  return file_.string() + ", its arm's meshes: " + meshes_.string();
}

RecordingBag::Channel& RecordingBag::channel_of(const std::string& topic, const std::string& type,
                                                Durability durability) {
  const auto known = channels_.find(topic);
  if (known != channels_.end()) return known->second;
  const auto [schema, is_new] = schemas_.try_emplace(type);
  if (is_new)
    schema->second = writer_.add_schema(type, "ros2msg", std::string(io::definition_of(type)));
  std::map<std::string, std::string> metadata;
  if (durability == Durability::latched) metadata.emplace("offered_qos_profiles", latched_qos);
  Channel& channel = channels_[topic];
  channel.id = writer_.add_channel(topic, "cdr", schema->second, std::move(metadata));
  return channel;
}

template <typename M>
void RecordingBag::write(const std::string& topic, std::int64_t stamp, const M& message,
                         Durability durability) {
  Channel& channel = channel_of(topic, std::string(io::message_type<M>()), durability);
  io::encode(message, payload_);
  writer_.write(channel.id, stamp, stamp, channel.messages++, payload_);
}

void RecordingBag::write_scene(std::int64_t stamp) {
  const auto latch = [&](const std::string& topic, const auto& message) {
    write(topic, stamp, message, Durability::latched);
  };
  const io::StringMessage urdf{read_whole_file(simulation_.urdf(), FileLimit::text)};
  const io::MessageHeader root{stamp, root_};
  io::TfMessage mounts{{{root, simulation_.camera().frame_id, simulation_.T_base_camera()}}};
  if (simulation_.arms().empty()) latch("/robot_description", urdf);
  for (const auto& [arm, T_world_root] : simulation_.arms()) {
    latch("/" + arm + "/robot_description", urdf);
    mounts.transforms.push_back({root, arm + "/" + arm_root, T_world_root});
  }
  if (second_camera_)
    mounts.transforms.push_back(
        {root, second_frame(simulation_), simulation_.T_base_second_camera()});
  latch("/tf_static", mounts);
  latch("/truth/scene", io::StringMessage{scene_});
  if (!simulation_.model_image().empty())
    latch("/truth/model/compressed",
          io::png_message({stamp, ""}, simulation_.model_image().view(), png_));
}

void RecordingBag::write_camera(const SimFrame& frame) {
  const Camera& camera = simulation_.camera();
  const io::MessageHeader header{frame.stamp, camera.frame_id};
  const io::CameraInfoMessage info = info_of(camera, header);
  write("/camera/depth/camera_info", frame.stamp, info);
  write("/camera/depth/image_rect_raw", frame.stamp,
        io::image_message(header, "16UC1", frame.depth.view()));
  write("/camera/color/camera_info", frame.stamp, info);
  write("/camera/color/image_raw/compressed", frame.stamp,
        io::png_message(header, frame.color.view(), png_));
}

void RecordingBag::write_second_camera(const SimFrame& frame) {
  const io::MessageHeader header{frame.stamp, second_frame(simulation_)};
  write("/second_camera/depth/camera_info", frame.stamp, info_of(simulation_.camera(), header));
  write("/second_camera/depth/image_rect_raw", frame.stamp,
        io::image_message(header, "16UC1", frame.second_depth.view()));
}

void RecordingBag::write_truth(const SimFrame& frame) {
  const io::MessageHeader in_root{frame.stamp, root_};
  const io::MessageHeader in_image{frame.stamp, simulation_.camera().frame_id};
  write("/truth/joint_states", frame.stamp,
        joint_states(simulation_.robot(), in_root, frame.true_joints));
  store_ids(frame, ids_);
  write("/truth/ids", frame.stamp,
        io::image_message(in_image, "16UC1", std::as_const(ids_).view()));
  io::TargetsMessage targets{.header = in_image, .root_frame = root_, .status = "ok"};
  for (const ObjectTruth& object : frame.objects) {
    write("/truth/" + object.name + "/pose", frame.stamp,
          io::PoseStampedMessage{in_root, object.T_base_object});
    targets.targets.push_back(target_of(object, frame.stamp));
  }
  write("/truth/targets", frame.stamp, targets);
}

void RecordingBag::add(const SimFrame& frame, std::size_t /*index*/) {
  if (channels_.empty()) write_scene(frame.stamp);
  const auto states = joint_states(simulation_.robot(), {frame.stamp, root_}, frame.joints);
  if (simulation_.arms().empty()) write("/joint_states", frame.stamp, states);
  for (const auto& [arm, T] : simulation_.arms()) {
    io::JointStateMessage own{.header = states.header};
    for (std::size_t i = 0; i < states.names.size(); ++i)
      if (states.names[i].starts_with(arm + "/")) {
        own.names.push_back(states.names[i].substr(arm.size() + 1));
        own.positions.push_back(states.positions[i]);
      }
    write("/" + arm + "/joint_states", frame.stamp, own);
  }
  write_truth(frame);  // targets precede their image
  write_camera(frame);
  if (second_camera_) write_second_camera(frame);
}

void RecordingBag::finish() {
  writer_.close();
  std::error_code error;
  if (!fs::exists(meshes_, error))
    fs::copy(simulation_.urdf().parent_path(), meshes_, fs::copy_options::recursive, error);
  if (error)
    throw InputError(meshes_.string() + ": cannot be written (" + error.message() +
                     "); choose another with -o");
  new_file(file_);  // checks again, because writing the frames took time
  pending_.finish();
}

}  // namespace penumbra::sim
