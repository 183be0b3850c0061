// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_scene.hpp>
#include <io/files/printable.hpp>
#include <io/ros/lidar_messages.hpp>

namespace penumbra::io {
namespace {

/// Returns the bag's faults for the end of an error message: the missing data may be in a damaged
/// part.
std::string damages_of(const std::vector<std::string>& notes) {
  std::string damages;
  for (const std::string& note : notes) damages += "; " + note;
  return damages;
}

}  // namespace

std::vector<std::string> bag_notes(const std::string& name, const BagReader& bag,
                                   const MessageFaults& faults) {
  std::vector<std::string> lines(bag.faults().begin(), bag.faults().end());
  for (const auto& [topic, fault] : faults.all())
    lines.push_back(name + ": " + std::to_string(fault.messages) +
                    (fault.messages == 1 ? " message of " : " messages of ") + printable(topic) +
                    " cannot be used, the first recorded at " + std::to_string(fault.first) +
                    " ns: " + fault.what);
  return lines;
}

BagSceneReader::BagSceneReader(const std::filesystem::path& bag, const BagOptions& options,
                               bool with_color)
    : bag_(open_bag(bag)), name_(bag.string()) {
  try {
    topics_ = choose_topics(name_, bag_->topics(), options, with_color);
  } catch (const InputError& error) {
    throw InputError(error.what() + damages_of(bag_notes(name_, *bag_, faults_)));
  }
}

void BagSceneReader::read_robot_and_camera() {
  if (read_until([this](const BagScene&) { return lacking().empty(); })) return;
  throw InputError(name_ + ": " + lacking() + " has no message that can be read" +
                   damages_of(bag_notes(name_, *bag_, faults_)));
}

bool BagSceneReader::read_until(const std::function<bool(const BagScene&)>& found) {
  BagMessage message;
  while (!found(scene_)) {
    if (!bag_->next(message)) return false;
    take(message);
  }
  return true;
}

void BagSceneReader::take(const BagMessage& message) {
  while (handlers_.size() <= message.topic)
    handlers_.push_back(handler_of(bag_->topics()[handlers_.size()]));
  if (const MessageHandler& handler = handlers_[message.topic])
    if (const auto fault = handler({.data = message.data}, message.log_time))
      faults_.add(bag_->topics()[message.topic].name, message.log_time, *fault);
}

MessageHandler BagSceneReader::handler_of(const BagTopic& topic) {
  const auto role = topics_.role_of(topic);
  if (!role) return {};
  const auto take_image = [this](const auto& image, const auto&, auto) {
    if (!scene_.depth_frame) scene_.depth_frame = image.header.frame_id;
  };
  const auto take_cloud = [this, name = topic.name](const auto& cloud, const auto&, auto) {
    scene_.cloud_frames.emplace(name, cloud.header.frame_id);
  };
  const auto take_info = [](std::optional<CameraInfoMessage>& kept) {
    return [&kept](const CameraInfoMessage& info, const auto&, auto) {
      if (!kept) kept = info;
    };
  };
  const auto take_transforms = [this, role](const TfMessage& found, const auto&, auto) {
    for (const TransformMessage& transform : found.transforms) {
      scene_.frames.add(transform.header.frame_id, transform.child_frame_id);
      if (role == TopicRole::static_transforms) scene_.static_transforms.push_back(transform);
    }
  };
  try {
    switch (*role) {
      case TopicRole::depth:
        if (is_read_as<ImageMessage>(topic.type))
          return make_handler<ImageMessage>(topic, take_image);
        if (is_read_as<CompressedVideoMessage>(topic.type))
          return make_handler<CompressedVideoMessage>(topic, take_image);
        return make_handler<CompressedImageMessage>(topic, take_image);
      case TopicRole::cloud:
        if (topic.type == message_type<LaserScanMessage>())
          return make_handler<LaserScanMessage>(topic, take_cloud);
        if (topic.type == message_type<LivoxMessage>())
          return make_handler<LivoxMessage>(topic, take_cloud);
        return make_handler<PointCloud2Message>(topic, take_cloud);
      case TopicRole::camera_info:
        return make_handler<CameraInfoMessage>(topic, take_info(scene_.camera_info));
      case TopicRole::color_info:
        return make_handler<CameraInfoMessage>(topic, take_info(scene_.color_info));
      case TopicRole::description:
        return make_handler<StringMessage>(
            topic, [this, robot = topics_.robot_of(topic)](const auto& text, const auto&, auto) {
              if (find_description(robot) == nullptr)
                scene_.descriptions.push_back({robot, text.data});
            });
      case TopicRole::transforms:
      case TopicRole::static_transforms:
        return make_handler<TfMessage>(topic, take_transforms);
      default:
        return {};
    }
  } catch (const InputError& error) {
    throw InputError(name_ + ": " + printable(topic.name) + ": " + error.what());
  }
}

const RobotDescription* BagSceneReader::find_description(const std::string& robot) const {
  for (const RobotDescription& description : scene_.descriptions)
    if (description.robot == robot) return &description;
  return nullptr;
}

/// Returns whether a static transform leads to a frame of a robot from another frame.
bool BagSceneReader::is_mounted(const std::string& robot) const {
  const auto is_of_robot = [&](const std::string& frame) {
    return frame_name(frame).starts_with(robot + "/");
  };
  const auto& all = scene_.static_transforms;
  return std::any_of(all.begin(), all.end(), [&](const TransformMessage& t) {
    return is_of_robot(t.child_frame_id) && !is_of_robot(t.header.frame_id);
  });
}

std::string BagSceneReader::lacking() const {
  for (const TopicUse& use : topics_.descriptions) {
    if (find_description(use.robot) == nullptr) return use.name;
    if (!use.robot.empty() && !is_mounted(use.robot))
      return "a static transform to robot '" + use.robot + "'";
  }
  for (const TopicUse& use : topics_.clouds)
    if (!scene_.cloud_frames.contains(use.name)) return use.name;
  if (!topics_.clouds.empty()) return {};
  if (!scene_.depth_frame) return topics_.depth.name;
  if (!scene_.camera_info) return topics_.camera_info.name;
  if (topics_.color_info && !scene_.color_info) return topics_.color_info->name;
  return {};
}

}  // namespace penumbra::io
