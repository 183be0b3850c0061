// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <string_view>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <penumbra_msgs/msg/keypoints.hpp>
#include <rclcpp/serialization.hpp>
#include <rclcpp/version.h>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <std_msgs/msg/string.hpp>
#include <tf2_msgs/msg/tf_message.hpp>
#include <vision_msgs/msg/detection2_d_array.hpp>
#include <vision_msgs/msg/detection3_d_array.hpp>

namespace penumbra_ros {
namespace {

using moveit_msgs::srv::GetPlanningScene;
using penumbra::io::TopicRole;
using sensor_msgs::msg::Image;

constexpr std::size_t image_depth = 8;     // images and clouds that are not read yet
constexpr std::size_t state_depth = 1000;  // joint states and transforms: a second of them

bool is_image(TopicRole role) {
  return role == TopicRole::depth || role == TopicRole::color || role == TopicRole::cloud;
}

/// Messages that are received as bytes.
bool is_generic(TopicRole role) {
  return role == TopicRole::attached || role == TopicRole::plan || role == TopicRole::cloud;
}

std::span<const std::byte> bytes_of(const rclcpp::SerializedMessage& message) {
  const rcl_serialized_message_t& rcl = message.get_rcl_serialized_message();
  return std::as_bytes(std::span(rcl.buffer, rcl.buffer_length));
}

/// Returns a number that differs between publishers.
std::uint64_t publisher_of(const rclcpp::MessageInfo& info) {
  const auto& gid = info.get_rmw_message_info().publisher_gid.data;
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(gid), sizeof(gid)});
}

/// Returns a message that refers to the data of `image`.
penumbra::io::ImageMessage image_message(const Image& image) {
  return {.header = {rclcpp::Time(image.header.stamp).nanoseconds(), image.header.frame_id},
          .height = image.height,
          .width = image.width,
          .encoding = image.encoding,
          .is_bigendian = image.is_bigendian,
          .step = image.step,
          .data = std::as_bytes(std::span(image.data))};
}

}  // namespace

Inputs::Inputs(rclcpp_lifecycle::LifecycleNode& node, penumbra::io::LiveRunner& runner)
    : node_(node), runner_(runner) {
  runner.with_inbox([&](const penumbra::io::LiveInbox& inbox) {
    for (const penumbra::io::InputTopic& topic : inbox.topics())
      links_.push_back(
          {.topic = topic, .subscription = nullptr, .scene = nullptr, .question = {}, .state = {}});
    return true;
  });
  for (Link& link : links_) {
    if (link.topic.type != "moveit_msgs/msg/PlanningScene") continue;
    const std::string space = link.topic.name.substr(0, link.topic.name.rfind('/') + 1);
    link.scene = node.create_client<GetPlanningScene>(space + "get_planning_scene");
  }
}

void Inputs::ask_for_scene(std::size_t topic) {
  Link& link = links_[topic];
  const auto last_stamp = [this] {
    return runner_.with_inbox(
        [](const penumbra::io::LiveInbox& inbox) { return inbox.robot().last_stamp(); });
  };
  const bool has_robot = runner_.with_inbox(
      [](const penumbra::io::LiveInbox& inbox) { return inbox.robot().posed() != nullptr; });
  const std::int64_t now = penumbra::io::LiveRunner::steady_now();
  if (!has_robot || !link.question.is_due(now)) return;
  link.scene->prune_pending_requests();  // an answer that comes late is of another question
  link.question.ask(now, last_stamp());
  using Components = moveit_msgs::msg::PlanningSceneComponents;
  const auto request = std::make_shared<GetPlanningScene::Request>();
  request->components.components = Components::ROBOT_STATE |
                                   Components::ROBOT_STATE_ATTACHED_OBJECTS |
                                   Components::WORLD_OBJECT_GEOMETRY;
  const auto take = [this, topic,
                     last_stamp](rclcpp::Client<GetPlanningScene>::SharedFuture answer) {
    const auto from = links_[topic].question.answer(last_stamp());
    if (!from) return;
    moveit_msgs::msg::PlanningScene& scene = answer.get()->scene;
    scene.robot_state.joint_state.header.stamp = rclcpp::Time(*from);
    for (auto& attached : scene.robot_state.attached_collision_objects)
      attached.object.header.stamp = rclcpp::Time(*from);
    const auto bytes = std::make_shared<rclcpp::SerializedMessage>();
    rclcpp::Serialization<moveit_msgs::msg::PlanningScene>().serialize_message(&scene, bytes.get());
    runner_.receive(topic, {bytes_of(*bytes), bytes, 0});
  };
  link.scene->async_send_request(request, take);
}

void Inputs::find_publishers(std::size_t topic) {
  Link& link = links_[topic];
  const auto publishers = node_.get_publishers_info_by_topic(link.topic.name);
  const std::string published = publishers.empty() ? "" : publishers.front().topic_type();
  const bool is_reliable =
      std::all_of(publishers.begin(), publishers.end(), [](const auto& publisher) {
        return publisher.qos_profile().reliability() == rclcpp::ReliabilityPolicy::Reliable;
      });
  if (!publishers.empty() && is_reliable != link.is_reliable) {
    link.is_reliable = is_reliable;
    link.subscription.reset();
    link.state.refused_because.clear();
  }
  const auto types = penumbra::io::LiveInbox::types_of(link.topic.role);
  if (link.topic.type.empty() && std::find(types.begin(), types.end(), published) != types.end()) {
    link.topic.type = published;
    runner_.with_inbox([&](penumbra::io::LiveInbox& inbox) {
      inbox.set_type(topic, published);
      return true;
    });
  }
  link.has_publisher = !publishers.empty();
  link.state.other_type = published == link.topic.type ? "" : published;
  link.state.other_topic =
      link.has_publisher ? "" : penumbra::io::other_topic(link.topic, [&](const std::string& name) {
        return node_.count_publishers(name) > 0;
      });
}

bool Inputs::waits_for_scene() const {
  return std::any_of(links_.begin(), links_.end(), [](const Link& link) {
    return link.scene && link.question.waits(link.scene->service_is_ready());
  });
}

/// Images that come between a service and the next follow() are not taken, either.
bool Inputs::takes(std::size_t topic) const {
  return !is_image(links_[topic].topic.role) || !waits_for_scene();
}

void Inputs::follow(bool with_color, bool enabled) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    find_publishers(i);
    Link& link = links_[i];
    if (link.scene)
      link.question.follow(link.scene->service_is_ready(), link.has_publisher,
                           penumbra::io::LiveRunner::steady_now());
  }
  const bool takes_images = enabled && !waits_for_scene();
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = links_[i];
    const TopicRole role = link.topic.role;
    const bool is_known = !is_generic(role) || link.has_publisher;
    const bool is_wanted = !link.topic.type.empty() && is_known &&
                           (role != TopicRole::color || with_color) &&
                           (takes_images || (role != TopicRole::depth && role != TopicRole::cloud));
    if (is_wanted && !link.subscription) link.subscription = subscribe(i);
    if (!is_wanted) link.subscription.reset();
    // A change after the answer comes by the subscription.
    const bool is_heard = link.subscription && link.subscription->get_publisher_count() > 0;
    if (link.scene && (is_heard || !link.has_publisher)) ask_for_scene(i);
  }
}

std::vector<penumbra::io::LiveLink> Inputs::links() const {
  std::vector<penumbra::io::LiveLink> links;
  for (const Link& link : links_) {
    links.push_back(link.state);
    links.back().is_open = link.subscription != nullptr;
    if (link.subscription)
      links.back().publishers = static_cast<int>(link.subscription->get_publisher_count());
  }
  return links;
}

rclcpp::QoS Inputs::qos_of(std::size_t topic) const {
  const penumbra::io::InputTopic& of = links_[topic].topic;
  rclcpp::QoS qos(is_image(of.role) ? image_depth : state_depth);
  if (!links_[topic].is_reliable && !of.latched) qos.best_effort();
  if (of.latched) qos.transient_local();
  return qos;
}

rclcpp::SubscriptionOptions Inputs::options_of(std::size_t topic) {
  rclcpp::SubscriptionOptions options;
  // Reliability is the publishers'.
  options.qos_overriding_options = {{rclcpp::QosPolicyKind::History, rclcpp::QosPolicyKind::Depth}};
  options.event_callbacks.incompatible_qos_callback =
      [this, topic](rclcpp::QOSRequestedIncompatibleQoSInfo& info) {
        const bool is_reliability = info.last_policy_kind == RMW_QOS_POLICY_RELIABILITY;
        links_[topic].state.refused_because = is_reliability ? "reliability" : "durability";
      };
  return options;
}

template <typename M>
rclcpp::SubscriptionBase::SharedPtr Inputs::subscribe_serialised(std::size_t topic) {
  auto options = options_of(topic);
  options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
  return node_.create_subscription<M>(
      links_[topic].topic.name, qos_of(topic),
      [this, topic](std::shared_ptr<const rclcpp::SerializedMessage> message,
                    const rclcpp::MessageInfo& info) {
        if (takes(topic)) runner_.receive(topic, {bytes_of(*message), message, publisher_of(info)});
      },
      options);
}

// rclcpp keeps latched messages of the same process out of the middleware: a later subscription
// gets them by intra-process communication alone.
template <typename M>
rclcpp::SubscriptionBase::SharedPtr Inputs::subscribe_latched(std::size_t topic) {
  auto options = options_of(topic);
#if !RCLCPP_VERSION_GTE(28, 0, 0)  // Jazzy; before, latched topics refuse it
  options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
#endif
  return node_.create_subscription<M>(
      links_[topic].topic.name, qos_of(topic),
      [this, topic](std::shared_ptr<const M> message, const rclcpp::MessageInfo& info) {
        const auto bytes = std::make_shared<rclcpp::SerializedMessage>();
        rclcpp::Serialization<M>().serialize_message(message.get(), bytes.get());
        runner_.receive(topic, {bytes_of(*bytes), bytes, publisher_of(info)});
      },
      options);
}

// Only where Livox's driver is installed are its messages known.
rclcpp::SubscriptionBase::SharedPtr Inputs::subscribe_generic(std::size_t topic) {
  const penumbra::io::InputTopic& of = links_[topic].topic;
  try {
    return node_.create_generic_subscription(
        of.name, of.type, qos_of(topic),
        [this, topic](std::shared_ptr<const rclcpp::SerializedMessage> message) {
          if (takes(topic)) runner_.receive(topic, {bytes_of(*message), message, 0});
        });
  } catch (const std::exception& error) {
    RCLCPP_WARN_ONCE(node_.get_logger(), "its messages are not known: %s: %s", of.name.c_str(),
                     error.what());
    return nullptr;
  }
}

// Images are received as such, because a driver in the same process hands them over without a copy.
rclcpp::SubscriptionBase::SharedPtr Inputs::subscribe_images(std::size_t topic) {
  return node_.create_subscription<Image>(
      links_[topic].topic.name, qos_of(topic),
      [this, topic](Image::ConstSharedPtr image) {
        if (takes(topic)) runner_.receive(topic, image_message(*image), image);
      },
      options_of(topic));
}

rclcpp::SubscriptionBase::SharedPtr Inputs::subscribe(std::size_t topic) {
  using Subscribe = rclcpp::SubscriptionBase::SharedPtr (Inputs::*)(std::size_t);
  static const std::map<std::string, Subscribe> by_type{
      {"std_msgs/msg/String", &Inputs::subscribe_latched<std_msgs::msg::String>},
      {"sensor_msgs/msg/JointState", &Inputs::subscribe_serialised<sensor_msgs::msg::JointState>},
      {"tf2_msgs/msg/TFMessage", &Inputs::subscribe_serialised<tf2_msgs::msg::TFMessage>},
      {"sensor_msgs/msg/CameraInfo", &Inputs::subscribe_serialised<sensor_msgs::msg::CameraInfo>},
      {"sensor_msgs/msg/Image", &Inputs::subscribe_images},
      {"sensor_msgs/msg/CompressedImage",
       &Inputs::subscribe_serialised<sensor_msgs::msg::CompressedImage>},
      {"vision_msgs/msg/Detection2DArray",
       &Inputs::subscribe_serialised<vision_msgs::msg::Detection2DArray>},
      {"vision_msgs/msg/Detection3DArray",
       &Inputs::subscribe_serialised<vision_msgs::msg::Detection3DArray>},
      {"penumbra_msgs/msg/Keypoints", &Inputs::subscribe_serialised<penumbra_msgs::msg::Keypoints>},
      {"geometry_msgs/msg/PoseStamped",
       &Inputs::subscribe_serialised<geometry_msgs::msg::PoseStamped>}};
  const penumbra::io::InputTopic& of = links_[topic].topic;
  if (is_generic(of.role)) return subscribe_generic(topic);
  if (of.latched && of.type == "tf2_msgs/msg/TFMessage")
    return subscribe_latched<tf2_msgs::msg::TFMessage>(topic);
  return (this->*by_type.at(of.type))(topic);
}

}  // namespace penumbra_ros
