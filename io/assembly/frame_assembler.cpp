// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <type_traits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/assembly/frame_assembler.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// Whether the targets of a message are regions of the image.
template <typename M>
constexpr bool is_of_pixels =
    std::is_same_v<M, Detection2DArrayMessage> || std::is_same_v<M, KeypointsMessage>;

}  // namespace

std::span<const std::string> FrameAssembler::types_of(TopicRole role) {
  static const std::array targets = {
      message_type<Detection2DArrayMessage>(), message_type<Detection3DArrayMessage>(),
      message_type<KeypointsMessage>(), message_type<PoseStampedMessage>()};
  static const std::array clouds = {message_type<PointCloud2Message>(),
                                    message_type<LaserScanMessage>(), message_type<LivoxMessage>()};
  if (role == TopicRole::targets) return targets;
  if (role == TopicRole::cloud) return clouds;
  return {};
}

FrameAssembler::FrameAssembler(RobotInputOptions robot,
                               const std::vector<CameraInputOptions>& cameras,
                               const std::vector<CloudInputOptions>& clouds)
    : robot_(std::move(robot)) {
  for (const CameraInputOptions& camera : cameras)
    cameras_.push_back(std::make_unique<CameraInput>(camera, robot_));
  for (const CloudInputOptions& cloud : clouds)
    clouds_.push_back(std::make_unique<CloudInput>(cloud, robot_));
  for (const auto& camera : cameras_) sensors_.push_back(camera.get());
  for (const auto& cloud : clouds_) sensors_.push_back(cloud.get());
}

std::size_t FrameAssembler::add_topic(InputTopic topic) {
  topics_.push_back(std::move(topic));
  received_.push_back(0);
  handlers_.emplace_back();
  handlers_.back() = handler_of(topics_.size() - 1);
  return topics_.size() - 1;
}

void FrameAssembler::set_type(std::size_t topic, const std::string& type) {
  topics_[topic].type = type;
  handlers_[topic] = handler_of(topic);
}

void FrameAssembler::receive(std::size_t topic, const SerializedMessage& message,
                             std::int64_t now) {
  ++received_[topic];
  if (!handlers_[topic]) return;
  const auto fault = handlers_[topic](message, now);
  if (!fault || topics_[topic].role == TopicRole::unused_joints) return;
  add_fault(topics_[topic].name, now, *fault);
  if (topics_[topic].role == TopicRole::depth && !message.is_skipped)
    cameras_[topics_[topic].camera]->take_unreadable(*fault, now);
}

void FrameAssembler::receive(std::size_t topic, const ImageMessage& image,
                             std::shared_ptr<const void> owner, std::int64_t now) {
  ++received_[topic];
  take_image(topic, keep_image(image, std::move(owner)), now);
}

void FrameAssembler::forget() {
  robot_.forget();
  follow_robot();
}

void FrameAssembler::set_robot(MadeRobot made) {
  robot_.set_robot(std::move(made));
  follow_robot();
}

void FrameAssembler::follow_robot() {
  for (SensorInput* const sensor : sensors_) sensor->refresh();
}

void FrameAssembler::note_sensor(std::int64_t stamp, double time_offset, std::int64_t now) {
  if (stamp > 0) note_lag(stamp_after(stamp, std::llround(1e9 * time_offset)), now, sensor_lag_);
}

/// Compares the clocks of the sensors and of the joint states by when their messages arrive.
std::string FrameAssembler::describe_clocks() const {
  constexpr double longest_latency = 1.0;  // seconds that a driver may take for an image
  constexpr double largest_offset = 10.0;  // of --time-offset
  const auto& joint_lag = robot_.joint_lag();
  if (!sensor_lag_ || !joint_lag) return {};
  const double offset =
      1e-9 * (static_cast<double>(*sensor_lag_) - static_cast<double>(*joint_lag));
  if (std::abs(offset) < longest_latency) return {};
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);  // the latencies of both are part of it
  text << "the stamps of joint states are about " << std::abs(offset) << " s "
       << (offset > 0 ? "after" : "before") << " the sensor's: ";
  if (std::abs(offset) > largest_offset)
    text << "do both use the same clock? (use_sim_time)";
  else
    text << "change time_offset by about " << offset << ", unless its data come so much later";
  return text.str();
}

std::vector<std::string> FrameAssembler::notes() const {
  std::vector<std::string> lines;
  if (robot_.posed()) lines = robot_.posed()->refusals();
  for (std::string& line : robot_.unused_topics()) lines.push_back(std::move(line));
  if (std::string clocks = describe_clocks(); !clocks.empty()) lines.push_back(std::move(clocks));
  return lines;
}

void FrameAssembler::finish() {
  for (SensorInput* const sensor : sensors_) sensor->finish();
}

template <typename M, typename F>
MessageHandler FrameAssembler::handler(std::size_t topic, F take) const {
  try {
    return make_handler<M>(topics_[topic], std::move(take));
  } catch (const InputError& error) {
    throw InputError(printable(topics_[topic].name) + ": " + error.what());
  }
}

MessageHandler FrameAssembler::handler_of(std::size_t topic) {
  const InputTopic& from = topics_[topic];
  switch (from.role) {
    case TopicRole::unused_joints:
      return handler_of_unused(topic);
    case TopicRole::description:
      return handler<StringMessage>(topic, [this, topic](const auto& text, const auto&, auto) {
        robot_.take(text, topics_[topic].robot);
        follow_robot();
      });
    case TopicRole::joints:
      return handler<JointStateMessage>(
          topic, [this, topic](const auto& state, const auto& message, std::int64_t now) {
            robot_.take(state, topics_[topic].robot,
                        sources_.of_joints(topics_[topic].name, message.publisher, state), now);
          });
    case TopicRole::transforms:
    case TopicRole::static_transforms:
      return handler<TfMessage>(
          topic, [this, topic](const auto& found, const auto& message, std::int64_t now) {
            robot_.take(found, topics_[topic].role == TopicRole::static_transforms,
                        sources_.of_transforms(topics_[topic].name, message.publisher), now);
            follow_robot();
          });
    case TopicRole::depth:
    case TopicRole::color:
      if (is_read_as<CompressedVideoMessage>(from.type)) return handler_of_video(topic);
      return is_read_as<ImageMessage>(from.type) ? handler_of_images<ImageMessage>(topic)
                                                 : handler_of_images<CompressedImageMessage>(topic);
    case TopicRole::camera_info:
    case TopicRole::color_info:
      return handler<CameraInfoMessage>(
          topic, [this, topic](const auto& info, const auto&, std::int64_t now) {
            take_info(topic, info, now);
          });
    case TopicRole::targets:
      return handler_of_targets(topic);
    case TopicRole::cloud:
      if (from.type.empty()) return {};
      if (from.type == message_type<LaserScanMessage>())
        return handler_of_clouds<LaserScanMessage>(topic);
      return from.type == message_type<LivoxMessage>()
                 ? handler_of_clouds<LivoxMessage>(topic)
                 : handler_of_clouds<PointCloud2Message>(topic);
    case TopicRole::attached:
      return from.type == message_type<PlanningSceneMessage>()
                 ? handler_of_attached<PlanningSceneMessage>(topic)
                 : handler_of_attached<AttachedObjectMessage>(topic);
    case TopicRole::plan:
      return from.type == message_type<DisplayTrajectoryMessage>()
                 ? handler_of_plans<DisplayTrajectoryMessage>(topic)
                 : handler_of_plans<JointTrajectoryMessage>(topic);
  }
  return {};
}

/// Messages of these topics that cannot be read are nobody's fault.
MessageHandler FrameAssembler::handler_of_unused(std::size_t topic) {
  try {
    const auto take = [this, topic](const auto& state, const auto&, auto) {
      robot_.take_unused(state, topics_[topic].name);
    };
    return handler<JointStateMessage>(topic, take);
  } catch (const InputError&) {
    return {};
  }
}

template <typename M>
MessageHandler FrameAssembler::handler_of_clouds(std::size_t topic) {
  return handler<M>(topic, [this, topic](M& cloud, const auto& message, std::int64_t now) {
    note_sensor(cloud.header.stamp, clouds_[topics_[topic].camera]->options().time_offset, now);
    const std::string fault = clouds_[topics_[topic].camera]->take(std::move(cloud), message, now);
    if (!fault.empty()) add_fault(topics_[topic].name, now, fault);
  });
}

template <typename M>
MessageHandler FrameAssembler::handler_of_attached(std::size_t topic) {
  return handler<M>(topic, [this, topic](const M& message, const auto&, std::int64_t now) {
    const std::string fault = robot_.take_attached(message, topics_[topic].robot);
    if (!fault.empty()) add_fault(topics_[topic].name, now, fault);
  });
}

template <typename M>
MessageHandler FrameAssembler::handler_of_plans(std::size_t topic) {
  return handler<M>(topic, [this, topic](const M& message, const auto&, std::int64_t now) {
    const std::string fault = robot_.take_plan(message, topics_[topic].robot);
    if (!fault.empty()) add_fault(topics_[topic].name, now, fault);
  });
}

template <typename M>
MessageHandler FrameAssembler::handler_of_images(std::size_t topic) {
  return handler<M>(topic, [this, topic](const M& image, const auto& message, std::int64_t now) {
    take_image(topic, keep_image(image, message.owner), now);
  });
}

MessageHandler FrameAssembler::handler_of_video(std::size_t topic) {
  auto video = std::make_shared<VideoStream>();
  return handler<CompressedVideoMessage>(
      topic, [this, topic, video](const auto& packet, const auto& message, std::int64_t now) {
        KeptImage image = keep_frame(packet, *video);
        if (!message.is_skipped) take_image(topic, std::move(image), now);
      });
}

void FrameAssembler::take_image(std::size_t topic, KeptImage image, std::int64_t now) {
  CameraInput& camera = *cameras_[topics_[topic].camera];
  note_sensor(image.header().stamp, camera.options().time_offset, now);
  if (topics_[topic].role == TopicRole::depth)
    camera.take_depth(std::move(image), now);
  else
    camera.take_color(std::move(image));
}

void FrameAssembler::take_info(std::size_t topic, const CameraInfoMessage& info, std::int64_t now) {
  CameraInput& camera = *cameras_[topics_[topic].camera];
  const bool differs = topics_[topic].role == TopicRole::camera_info ? camera.take_info(info)
                                                                     : camera.take_color_info(info);
  if (differs) add_fault(topics_[topic].name, now, "is of another camera than the first one");
}

MessageHandler FrameAssembler::handler_of_targets(std::size_t topic) {
  const std::string& type = topics_[topic].type;
  if (type.empty()) return {};
  if (type == message_type<Detection2DArrayMessage>())
    return handler_of_targets_as<Detection2DArrayMessage>(topic);
  if (type == message_type<Detection3DArrayMessage>())
    return handler_of_targets_as<Detection3DArrayMessage>(topic);
  if (type == message_type<KeypointsMessage>())
    return handler_of_targets_as<KeypointsMessage>(topic);
  return handler_of_targets_as<PoseStampedMessage>(topic);
}

template <typename M>
MessageHandler FrameAssembler::handler_of_targets_as(std::size_t topic) {
  return handler<M>(topic, [this, topic](const M& found, const auto&, auto) {
    // A message is for the sensors that know its frame. One that no sensor knows may be for a
    // camera without setup; if all have one, all sensors take the message and report the mismatch.
    const auto sensors =
        std::span(sensors_).first(is_of_pixels<M> ? cameras_.size() : sensors_.size());
    const auto knows = [&](const SensorInput* sensor) {
      return sensor->setup() != nullptr &&
             sensor->setup()->targets.knows(found.header.frame_id, is_of_pixels<M>);
    };
    const auto lacks_setup = [](const SensorInput* sensor) { return sensor->setup() == nullptr; };
    const bool is_known = std::ranges::any_of(sensors, knows);
    const bool is_early =
        std::ranges::any_of(std::span(sensors_).first(cameras_.size()), lacks_setup);
    for (SensorInput* const sensor : sensors)
      if (is_known ? knows(sensor) : !is_early || lacks_setup(sensor))
        sensor->take_targets(topics_[topic].name, found);
  });
}

}  // namespace penumbra::io
