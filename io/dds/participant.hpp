// SPDX-License-Identifier: Apache-2.0
// The graph of ROS 2's topics, through DDS. Messages are CDR bytes of any type and are not decoded
// here.
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

#include <io/assembly/message_handler.hpp>

namespace penumbra::io {

struct TopicQos {
  bool reliable = false;  ///< false: best effort
  bool latched = false;   ///< transient local: late subscribers also get the last messages
  int depth = 5;          ///< keep last this many; at least 1

  bool operator==(const TopicQos&) const = default;
};

struct ParticipantOptions {
  std::optional<int> domain;  ///< 0..232; default: ROS_DOMAIN_ID, or else 0
};

/// The counts of a subscription since it was made: received = taken + overwritten + waiting.
struct SubscriptionStatus {
  int publishers = 0;             ///< matched now by type and QoS
  std::uint64_t received = 0;     ///< complete messages
  std::uint64_t taken = 0;        ///< received messages that take() returned
  std::uint64_t overwritten = 0;  ///< received messages that newer ones replaced before take()
  /// Messages missing between two received ones of a publisher, by its sequence numbers. They were
  /// dropped in transport or, with reliable QoS, given up by a publisher whose history is too
  /// short.
  std::uint64_t lost = 0;
  std::uint64_t refused = 0;    ///< publishers with incompatible QoS
  std::string refused_because;  ///< the policy of the last one: "reliability"; empty: none
};

class Subscription {
 public:
  Subscription() = default;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;
  virtual ~Subscription() = default;

  /// Takes the next message in the order of arrival. Returns false if there is none.
  virtual bool take(SerializedMessage& message) = 0;

  [[nodiscard]] virtual SubscriptionStatus status() const = 0;
};

class Publication {
 public:
  Publication() = default;
  Publication(const Publication&) = delete;
  Publication& operator=(const Publication&) = delete;
  virtual ~Publication() = default;

  /// Writes a message: CDR with 4 bytes of encapsulation, which is copied. Returns at once, unless
  /// reliable subscribers are behind: then it waits up to 0.1 s. Returns false if they are still
  /// behind or memory is short; then no subscriber gets the message.
  [[nodiscard]] virtual bool write(std::span<const std::byte> data) = 0;

  /// Waits until reliable subscribers have all written messages. Returns false on timeout.
  virtual bool flush(std::chrono::nanoseconds at_most) = 0;

  /// Returns the number of matched subscribers, including those of this participant.
  [[nodiscard]] virtual int subscribers() const = 0;

  /// Returns the number of messages that left the history, as far as the middleware shows it,
  /// before all reliable subscribers acknowledged them: those subscribers may have lost them. The
  /// thread of write() calls this.
  [[nodiscard]] virtual std::uint64_t unacknowledged() const = 0;
};

struct GraphEndpoint {
  TopicQos qos;      ///< depth is 0: not part of discovery
  std::string host;  ///< empty if its participant does not publish it
  bool own = false;  ///< belongs to this participant

  bool operator==(const GraphEndpoint&) const = default;
};

/// A topic of ROS 2. Two topics with one name have different types.
struct GraphTopic {
  std::string name;  ///< "/camera/depth/image_rect_raw"
  std::string type;  ///< "sensor_msgs/msg/Image"
  std::vector<GraphEndpoint> publishers, subscribers;
};

/// A program on the graph. Any thread may call all functions, but only one thread at a time may be
/// in wait(), in take() of one subscription and in write() of one publication. Destroy
/// subscriptions and publications before their participant.
class Participant {
 public:
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  virtual ~Participant() = default;

  /// `topic`: "/a/b"; `type`: "sensor_msgs/msg/Image". Both functions throw InputError for an
  /// invalid name of ROS 2, and for a topic that this participant already has with another type.
  /// `definition`: the ros2msg text of a type that is not built in, for its hash.
  [[nodiscard]] virtual std::unique_ptr<Subscription> subscribe(const std::string& topic,
                                                                const std::string& type,
                                                                const TopicQos& qos) = 0;
  [[nodiscard]] virtual std::unique_ptr<Publication> advertise(
      const std::string& topic, const std::string& type, const TopicQos& qos,
      std::string_view definition = {}) = 0;

  /// Waits until a subscription has messages or wake() is called. Returns false on timeout.
  virtual bool wait(std::chrono::nanoseconds at_most) = 0;

  /// Ends the current wait(), or the next one.
  virtual void wake() = 0;

  /// Returns the topics discovered so far, ordered by name and type.
  [[nodiscard]] virtual std::vector<GraphTopic> graph() const = 0;

  [[nodiscard]] virtual int domain() const = 0;

  /// Returns the warnings of the middleware since the last call, one line each.
  [[nodiscard]] virtual std::vector<std::string> take_warnings() = 0;
};

/// Joins ROS 2's graph. Environment, as in ROS 2 Jazzy: ROS_DOMAIN_ID,
/// ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS, ROS_LOCALHOST_ONLY=1 (the range LOCALHOST,
/// without static peers) and CYCLONEDDS_URI, which overrides everything else. Throws InputError
/// with one line that says what to do for a bad domain, for invalid settings in CYCLONEDDS_URI,
/// and without a network.
[[nodiscard]] std::unique_ptr<Participant> join_graph(const ParticipantOptions& options);

/// Returns the domain that join_graph() uses. Throws InputError.
[[nodiscard]] int graph_domain(const ParticipantOptions& options);

/// Returns the range in which join_graph() finds others: SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT.
/// Throws InputError.
[[nodiscard]] std::string discovery_range();

}  // namespace penumbra::io
