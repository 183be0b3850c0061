// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <io/assembly/message_faults.hpp>
#include <io/assembly/message_sources.hpp>
#include <io/live/latency_histogram.hpp>
#include <io/live/live_camera.hpp>
#include <io/live/live_robot.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {

/// The content of a topic.
enum class LiveRole {
  description,
  joints,
  transforms,
  static_transforms,
  depth,
  camera_info,
  color,
  color_info,
  targets
};

struct LiveTopic {
  LiveRole role = LiveRole::depth;
  std::size_t camera = 0;  ///< for topics of one camera
  std::string name = {};
  std::string type = {};  ///< empty if there are several, see LiveInbox::set_type
  bool latched = false;   ///< published once, and kept for late subscribers
};

/// Topic names are those on the graph, after remapping and with namespaces.
struct LiveOptions {
  LiveRobotOptions robot = {};
  PoseSource poses = PoseSource::joints;
  std::string description_topic = "/robot_description";
  std::vector<std::string> joint_topics = {"/joint_states"};
  std::string transform_topic = "/tf";
  std::string static_transform_topic = "/tf_static";
  std::vector<std::string> target_topics = {};
  std::vector<LiveCameraOptions> cameras = {};
};

/// A received message in CDR.
struct LiveMessage {
  std::span<const std::byte> data;
  std::shared_ptr<const void> owner;  ///< keeps `data` alive; null: data that is kept is copied
  std::uint64_t publisher = 0;        ///< a unique number; 0: not known
};

/// The results of a camera's images.
struct LiveTally {
  std::map<std::string, std::size_t, std::less<>> statuses;  ///< frames by status
  LatencyHistogram latency;      ///< from stamp to published, ms of the system's clock
  LatencyHistogram processing;   ///< from arrival to published, ms
  std::size_t beyond_clock = 0;  ///< images with stamps of another clock; no latency
  LiveOutcome last;
  std::optional<RendererInfo> renderer;        ///< the last one; nothing if no image was judged yet
  std::optional<std::int64_t> last_published;  ///< on the caller's clock
};

/// Receives the messages of the graph: one robot and its cameras. Uses no transport, threads or
/// clock: `now` is nanoseconds of a steady clock. Use one thread at a time; only jobs may be
/// processed meanwhile.
class LiveInbox {
 public:
  /// Throws InputError for options that LiveCamera refuses.
  explicit LiveInbox(const LiveOptions& options);

  /// Returns the topics to subscribe to.
  [[nodiscard]] std::span<const LiveTopic> topics() const { return topics_; }
  /// Sets the message type of a target topic.
  void set_type(std::size_t topic, const std::string& type) { topics_[topic].type = type; }
  /// Returns the message types that targets may have.
  [[nodiscard]] static std::span<const std::string> target_types();

  /// Receives a message of topics()[topic]. Messages that cannot be read are counted.
  void receive(std::size_t topic, const LiveMessage& message, std::int64_t now);

  /// Returns LiveRobot::take_order(). Call this after a robot_description was received.
  [[nodiscard]] std::unique_ptr<const RobotOrder> take_order() { return robot_.take_order(); }
  void place(MadeRobot made);
  void retry_robot() { robot_.retry(); }

  /// See LiveCamera::next.
  bool next(std::size_t camera, std::int64_t now, bool with_color, LiveJob& job) {
    return cameras_[camera]->next(now, with_color, job);
  }
  /// Counts the outcome of a job. Call this once for each job. `system_now`: nanoseconds since
  /// 1970.
  void done(std::size_t camera, const LiveOutcome& outcome, std::int64_t now,
            std::int64_t system_now);
  [[nodiscard]] std::optional<std::int64_t> wake_at(std::size_t camera) const {
    return cameras_[camera]->wake_at();
  }

  [[nodiscard]] const LiveOptions& options() const { return options_; }
  [[nodiscard]] const LiveRobot& robot() const { return robot_; }
  [[nodiscard]] std::size_t camera_count() const { return cameras_.size(); }
  [[nodiscard]] const LiveCamera& camera(std::size_t i) const { return *cameras_[i]; }
  [[nodiscard]] const LiveTally& tally(std::size_t i) const { return tallies_[i]; }
  [[nodiscard]] const MessageFaults& faults() const { return faults_; }
  /// Returns the number of messages of each topic, in the order of topics().
  [[nodiscard]] std::span<const std::size_t> received() const { return received_; }

 private:
  template <typename M>
  bool decode(std::size_t topic, const LiveMessage& message, std::int64_t now, M& decoded);
  template <typename M>
  void receive_image(std::size_t topic, const LiveMessage& message, std::int64_t now);
  void receive_of_robot(std::size_t topic, const LiveMessage& message, std::int64_t now);
  void receive_targets(std::size_t topic, const LiveMessage& message, std::int64_t now);
  template <typename M>
  void receive_targets_as(std::size_t topic, const LiveMessage& message, std::int64_t now);

  LiveOptions options_;
  LiveRobot robot_;
  std::vector<std::unique_ptr<LiveCamera>> cameras_;
  std::vector<LiveTally> tallies_;
  std::vector<LiveTopic> topics_;
  std::vector<std::size_t> received_;
  MessageFaults faults_;
  MessageSources sources_;
};

}  // namespace penumbra::io
