// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <io/assembly/result_encoder.hpp>
#include <io/dds/participant.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_runner.hpp>
#include <io/live/live_summary.hpp>

namespace penumbra::app {

/// Returns the QoS of a subscription. `reliable`: for all topics.
[[nodiscard]] io::TopicQos live_qos(const io::InputTopic& topic, bool reliable);

/// Publishes the results of a camera that have subscribers.
class GraphResults final : public io::ResultSink {
 public:
  /// `name_of`: the topic of a result, "/penumbra/labels"; empty: it is not published.
  GraphResults(io::Participant& graph,
               const std::function<std::string(const io::ResultTopic&)>& name_of);

  [[nodiscard]] bool wants(io::Result result) const override;
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override;

  /// Returns the numbers of published results. Any thread may call this.
  [[nodiscard]] io::WrittenResults counts() const;

 private:
  std::array<std::unique_ptr<io::Publication>, io::result_topics.size()> publications_;
  std::array<std::atomic<std::size_t>, io::result_topics.size()> written_ = {};
  std::atomic<std::size_t> not_written_ = 0, unacknowledged_ = 0;
};

/// Publishes the clouds of a sensor that have subscribers, with the type of its messages.
class GraphClouds final : public io::ResultSink {
 public:
  /// `topics`: of the clouds without the robot, labelled ones, and targets.
  GraphClouds(io::Participant& graph, std::array<std::string, 3> topics)
      : graph_(graph), topics_(std::move(topics)) {}

  void set_cloud_type(const std::string& type) override;
  [[nodiscard]] bool wants(io::Result result) const override;
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override;

  /// Returns how many were not published because subscribers were behind. Any thread may call this.
  [[nodiscard]] std::size_t not_written() const { return not_written_; }

 private:
  io::Participant& graph_;
  std::array<std::string, 3> topics_;
  std::map<io::Result, std::unique_ptr<io::Publication>> publications_;
  std::atomic<std::size_t> not_written_ = 0;
};

/// Hands a graph's messages to a runner. One thread calls receive(); any thread calls the rest.
class LiveSubscriptions {
 public:
  LiveSubscriptions(io::Participant& graph, io::LiveRunner& runner, bool reliable);

  /// Subscribes to the topics whose types are known by now; to color images while `with_color`.
  void follow(bool with_color);

  /// Waits for messages, at most `at_most`, and hands them on.
  void receive(std::chrono::nanoseconds at_most);

  /// Returns the state of each of the runner's topics.
  [[nodiscard]] std::vector<io::LiveLink> links() const;

 private:
  [[nodiscard]] std::string type_on_graph(const std::string& topic,
                                          const std::vector<io::GraphTopic>& all) const;
  void open(std::size_t topic);
  void close(std::size_t topic);

  io::Participant& graph_;
  io::LiveRunner& runner_;
  bool reliable_;
  std::vector<io::InputTopic> topics_;
  mutable std::mutex mutex_;  // guards the members below; lock it before the runner's
  std::vector<std::unique_ptr<io::Subscription>> subscriptions_;  // null: not subscribed to
  std::vector<io::LiveLink> known_;  // losses of closed subscriptions, and other types and topics
};

}  // namespace penumbra::app
