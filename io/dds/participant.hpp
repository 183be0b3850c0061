// SPDX-License-Identifier: Apache-2.0
// ROS 2's graph of topics, through DDS. Messages are bytes in CDR of any type: what they mean is
// not known here.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

struct TopicQos {
  bool reliable = false;  ///< else best effort
  bool latched = false;   ///< transient local: who comes late gets the last messages, too
  int depth = 5;          ///< keep last; from 1

  bool operator==(const TopicQos&) const = default;
};

struct ParticipantOptions {
  std::optional<int> domain;  ///< 0..232; nothing: ROS_DOMAIN_ID, or 0
};

struct Sample {
  /// CDR with its 4 bytes of encapsulation; up to 3 bytes of padding may follow.
  std::span<const std::byte> data;
  std::shared_ptr<const void> owner;  ///< keeps `data` alive, without a copy, as long as it lives
  std::int64_t source_time = 0;       ///< nanoseconds since 1970: when it was written, by DDS
  std::uint64_t publisher = 0;        ///< whose it is: a number that no other one ever has here
};

/// What a subscription has seen since it was made. received = taken + overwritten + waiting.
struct SubscriptionStatus {
  int publishers = 0;             ///< now, those whose type and QoS fit
  std::uint64_t received = 0;     ///< messages that arrived whole
  std::uint64_t taken = 0;        ///< of these, those that take() gave
  std::uint64_t overwritten = 0;  ///< of these, those that newer ones replaced before take()
  /// Messages between two of a publisher that arrived, by its numbers: dropped on the way, or, with
  /// QoS reliable, given up by a publisher that keeps too few for those who are behind.
  std::uint64_t lost = 0;
  std::uint64_t refused = 0;    ///< publishers that were met whose QoS does not fit
  std::string refused_because;  ///< the last one's policy: "reliability"; empty: none
};

class Subscription {
 public:
  Subscription() = default;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;
  virtual ~Subscription() = default;

  /// The next message in the order of arrival; false if there is none now.
  virtual bool take(Sample& sample) = 0;

  [[nodiscard]] virtual SubscriptionStatus status() const = 0;
};

class Publication {
 public:
  Publication() = default;
  Publication(const Publication&) = delete;
  Publication& operator=(const Publication&) = delete;
  virtual ~Publication() = default;

  /// Writes a message: CDR with its 4 bytes of encapsulation, which are copied. Returns at once but
  /// for reliable subscribers that are behind: it waits for those at most 0.1 s. False: they still
  /// are, or memory is short, and the message was not written, for nobody.
  [[nodiscard]] virtual bool write(std::span<const std::byte> data) = 0;

  /// Waits until reliable subscribers have all that was written. False: not in that time.
  virtual bool flush(std::chrono::nanoseconds at_most) = 0;

  /// Matched now, those of this participant included.
  [[nodiscard]] virtual int subscribers() const = 0;
};

struct GraphEndpoint {
  TopicQos qos;      ///< depth is 0: discovery does not tell it
  std::string host;  ///< empty: its participant does not tell
  bool own = false;  ///< of this participant

  bool operator==(const GraphEndpoint&) const = default;
};

/// A topic of ROS 2's. Two of one name have different types.
struct GraphTopic {
  std::string name;  ///< "/camera/depth/image_rect_raw"
  std::string type;  ///< "sensor_msgs/msg/Image"
  std::vector<GraphEndpoint> publishers, subscribers;
};

/// One program on the graph. All functions may be called from any thread, but one thread at a time
/// in wait(), in take() of one subscription and in write() of one publication. Subscriptions and
/// publications must be gone before their participant.
class Participant {
 public:
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  virtual ~Participant() = default;

  /// `topic`: "/a/b"; `type`: "sensor_msgs/msg/Image". Both throw InputError that names what is no
  /// name of ROS 2's, or a topic of which this participant has another type.
  [[nodiscard]] virtual std::unique_ptr<Subscription> subscribe(const std::string& topic,
                                                                const std::string& type,
                                                                const TopicQos& qos) = 0;
  [[nodiscard]] virtual std::unique_ptr<Publication> advertise(const std::string& topic,
                                                               const std::string& type,
                                                               const TopicQos& qos) = 0;

  /// Waits until a subscription has messages, or wake(). False: nothing in that time.
  virtual bool wait(std::chrono::nanoseconds at_most) = 0;

  /// Ends wait(), or the next one.
  virtual void wake() = 0;

  /// What discovery has shown so far, ordered by name and type.
  [[nodiscard]] virtual std::vector<GraphTopic> graph() const = 0;

  [[nodiscard]] virtual int domain() const = 0;

  /// What the middleware has complained of since the last call, one line each.
  [[nodiscard]] virtual std::vector<std::string> take_complaints() = 0;
};

/// Joins ROS 2's graph. Environment: ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY=1 (this machine alone,
/// without multicast) and CYCLONEDDS_URI, which overrides all else. Throws InputError, one line
/// that says what to do, for a bad domain, for what CYCLONEDDS_URI must not say, where there is no
/// network, and in builds without DDS.
[[nodiscard]] std::unique_ptr<Participant> join_graph(const ParticipantOptions& options);

/// The domain that join_graph() takes. Throws InputError.
[[nodiscard]] int graph_domain(const ParticipantOptions& options);

/// Whether this build has DDS.
[[nodiscard]] bool has_dds();

}  // namespace penumbra::io
