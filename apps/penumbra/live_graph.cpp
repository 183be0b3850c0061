// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <apps/penumbra/live_graph.hpp>

namespace penumbra::app {
namespace {

constexpr int result_depth = 10;   // of results that a subscriber has not fetched
constexpr int image_depth = 8;     // of images and clouds that are not read yet
constexpr int state_depth = 1000;  // of joint states and transforms: a second of them

bool is_image(io::TopicRole role) {
  return role == io::TopicRole::depth || role == io::TopicRole::color ||
         role == io::TopicRole::cloud;
}

}  // namespace

io::TopicQos live_qos(const io::InputTopic& topic, bool reliable) {
  return {.reliable = reliable || topic.latched,
          .latched = topic.latched,
          .depth = is_image(topic.role) ? image_depth : state_depth};
}

GraphResults::GraphResults(io::Participant& graph,
                           const std::function<std::string(const io::ResultTopic&)>& name_of) {
  for (const io::ResultTopic& topic : io::result_topics)
    if (const std::string name = name_of(topic); !name.empty())
      publications_[static_cast<std::size_t>(topic.result)] =
          graph.advertise(name, std::string(topic.type), {.reliable = true, .depth = result_depth});
}

bool GraphResults::wants(io::Result result) const {
  const auto& publication = publications_[static_cast<std::size_t>(result)];
  return publication && publication->subscribers() > 0;
}

void GraphResults::write(io::Result result, std::int64_t /*stamp*/,
                         std::span<const std::byte> payload) {
  const auto topic = static_cast<std::size_t>(result);
  io::Publication& publication = *publications_[topic];
  const std::uint64_t before = publication.unacknowledged();
  ++(publication.write(payload) ? written_[topic] : not_written_);
  unacknowledged_ += publication.unacknowledged() - before;
}

io::WrittenResults GraphResults::counts() const {
  io::WrittenResults counts;
  std::copy(written_.begin(), written_.end(), counts.written.begin());
  counts.not_written = not_written_;
  counts.unacknowledged = unacknowledged_;
  return counts;
}

void GraphClouds::set_cloud_type(const std::string& type) {
  const auto advertise = [&](io::Result result, const std::string& topic, const std::string& of) {
    if (!publications_[result])
      publications_[result] =
          graph_.advertise(topic, of, {.reliable = true, .depth = result_depth});
  };
  advertise(io::Result::without_robot, topics_[0], type);
  if (type == io::message_type<io::PointCloud2Message>())
    advertise(io::Result::labelled, topics_[1], type);
  advertise(io::Result::targets, topics_[2], io::message_type<io::TargetsMessage>());
}

bool GraphClouds::wants(io::Result result) const {
  const auto found = publications_.find(result);
  return found != publications_.end() && found->second->subscribers() > 0;
}

void GraphClouds::write(io::Result result, std::int64_t /*stamp*/,
                        std::span<const std::byte> payload) {
  if (!publications_[result]->write(payload)) ++not_written_;
}

LiveSubscriptions::LiveSubscriptions(io::Participant& graph, io::LiveRunner& runner, bool reliable)
    : graph_(graph), runner_(runner), reliable_(reliable) {
  topics_ = runner.with_inbox([](const io::LiveInbox& inbox) {
    return std::vector<io::InputTopic>(inbox.topics().begin(), inbox.topics().end());
  });
  subscriptions_.resize(topics_.size());
  known_.resize(topics_.size());
}

std::string LiveSubscriptions::type_on_graph(const std::string& topic,
                                             const std::vector<io::GraphTopic>& all) const {
  for (const io::GraphTopic& one : all)
    if (one.name == topic && !one.publishers.empty()) return one.type;
  return {};
}

void LiveSubscriptions::open(std::size_t topic) {
  subscriptions_[topic] = graph_.subscribe(topics_[topic].name, topics_[topic].type,
                                           live_qos(topics_[topic], reliable_));
}

void LiveSubscriptions::close(std::size_t topic) {
  if (!subscriptions_[topic]) return;
  const io::SubscriptionStatus status = subscriptions_[topic]->status();
  known_[topic].lost += status.lost;
  known_[topic].overwritten += status.overwritten;
  subscriptions_[topic].reset();
}

void LiveSubscriptions::follow(bool with_color) {
  const std::vector<io::GraphTopic> all = graph_.graph();
  const auto is_published = [&](const std::string& name) {
    return !type_on_graph(name, all).empty();
  };
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    io::InputTopic& topic = topics_[i];
    const std::string type = type_on_graph(topic.name, all);
    if (topic.type.empty()) {
      const auto types = io::LiveInbox::types_of(topic.role);
      if (std::find(types.begin(), types.end(), type) != types.end()) {
        topic.type = type;
        runner_.with_inbox([&](io::LiveInbox& inbox) {
          inbox.set_type(i, type);
          return true;
        });
      }
    }
    const bool is_wanted =
        !topic.type.empty() && (topic.role != io::TopicRole::color || with_color);
    if (is_wanted && !subscriptions_[i]) open(i);
    if (!is_wanted) close(i);
    known_[i].other_type = type == topic.type ? "" : type;
    known_[i].other_topic = type.empty() ? io::other_topic(topic, is_published) : "";
  }
}

void LiveSubscriptions::receive(std::chrono::nanoseconds at_most) {
  graph_.wait(at_most);
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < subscriptions_.size(); ++i) {
    if (!subscriptions_[i]) continue;
    for (io::SerializedMessage message; subscriptions_[i]->take(message);)
      runner_.receive(i, message);
  }
}

std::vector<io::LiveLink> LiveSubscriptions::links() const {
  const std::lock_guard lock(mutex_);
  std::vector<io::LiveLink> links(subscriptions_.size());
  for (std::size_t i = 0; i < subscriptions_.size(); ++i) {
    links[i] = known_[i];
    if (!subscriptions_[i]) continue;
    const io::SubscriptionStatus status = subscriptions_[i]->status();
    links[i].is_open = true;
    links[i].publishers = status.publishers;
    links[i].lost += status.lost;
    links[i].overwritten += status.overwritten;
    links[i].refused_because = status.refused_because;
  }
  return links;
}

}  // namespace penumbra::app
