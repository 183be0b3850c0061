// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <io/assembly/camera_input.hpp>
#include <io/assembly/cloud_input.hpp>
#include <io/assembly/input_topic.hpp>
#include <io/assembly/message_faults.hpp>
#include <io/assembly/message_handler.hpp>
#include <io/assembly/message_sources.hpp>
#include <io/assembly/robot_input.hpp>

namespace penumbra::io {

/// Makes frames of ROS 2 messages: one robot, its cameras, and its sensors that measure points. A
/// sensor's number counts the cameras first.
///
/// In: serialised messages, each with the topic's role, and the time at which it arrived on any
/// clock of the caller: a steady clock, or a bag's log time.
/// Out: frames, one sensor at a time. Each has a depth image or a scan, the poses of robot and
/// sensor at its own stamp, the targets received since the last frame, and the colour image nearest
/// in time. What is not known is a status of the frame. Messages that do not become frames are
/// counted with the reason. See SensorInput for which frames come out.
///
/// This class knows no transport, starts no thread and reads no clock. Its callers are the bag
/// reader (BagSource), the DDS subscriptions (LiveRunner) and, like them, any other node. One
/// thread at a time may call it. An AssembledFrame may be judged meanwhile by another thread, one
/// for each sensor; it comes back by done(). Its pose_at reads the robot's poses, and needs the
/// lock of whoever calls this.
class FrameAssembler {
 public:
  /// Throws InputError for options that FrameQueue refuses, if a camera is known; otherwise its
  /// frames have the fault.
  FrameAssembler(RobotInputOptions robot, const std::vector<CameraInputOptions>& cameras,
                 const std::vector<CloudInputOptions>& clouds = {});
  FrameAssembler(const FrameAssembler&) = delete;
  FrameAssembler& operator=(const FrameAssembler&) = delete;
  virtual ~FrameAssembler() = default;

  /// Adds a topic. Returns its index in topics(). Throws InputError that names the topic if its
  /// definition has other fields than those that are read.
  std::size_t add_topic(InputTopic topic);
  [[nodiscard]] std::span<const InputTopic> topics() const { return topics_; }
  /// Sets the message type of a topic of targets or clouds, one of types_of().
  void set_type(std::size_t topic, const std::string& type);
  [[nodiscard]] static std::span<const std::string> types_of(TopicRole role);

  /// Receives a message of topics()[topic]. Messages that cannot be read are counted.
  void receive(std::size_t topic, const SerializedMessage& message, std::int64_t now);
  /// Receives a decoded image. `owner` keeps its pixels alive; null: they are copied.
  void receive(std::size_t topic, const ImageMessage& image, std::shared_ptr<const void> owner,
               std::int64_t now);

  /// Forgets all poses, targets and waiting images. The robot and the cameras stay.
  void forget();

  /// Returns the robot to make, once, or null: a robot_description was received. Reading its meshes
  /// takes time, so that the caller chooses the thread. set_robot() takes the made robot.
  [[nodiscard]] std::unique_ptr<const RobotLoadRequest> take_load_request() {
    return robot_.take_load_request();
  }
  void set_robot(MadeRobot made);
  /// Requests a robot again that could not be made: its meshes may exist now.
  void retry_robot() { robot_.retry(); }

  /// Sets `frame` to the next frame of a sensor. Returns false if none is ready. Call it until then
  /// after messages were received, and at wake_at(). `with_color`: adds the colour image.
  bool next(std::size_t sensor, std::int64_t now, bool with_color, AssembledFrame& frame) {
    return sensors_[sensor]->next(now, with_color, frame);
  }
  /// Counts the outcome of a frame. Call this once for each frame. `unjudged_targets`: its targets,
  /// if it could not be judged.
  void done(std::size_t sensor, bool is_judged, std::size_t unjudged_targets = 0) {
    sensors_[sensor]->done(is_judged, unjudged_targets);
  }
  /// Returns when next() will have a frame even if no message arrives.
  [[nodiscard]] std::optional<std::int64_t> wake_at(std::size_t sensor) const {
    return sensors_[sensor]->wake_at();
  }
  /// Ends all waits: no further message will come.
  void finish();

  [[nodiscard]] const RobotInput& robot() const { return robot_; }
  [[nodiscard]] std::size_t camera_count() const { return cameras_.size(); }
  [[nodiscard]] const CameraInput& camera(std::size_t i) const { return *cameras_[i]; }
  [[nodiscard]] std::size_t cloud_count() const { return clouds_.size(); }
  [[nodiscard]] const CloudInput& cloud(std::size_t i) const { return *clouds_[i]; }
  [[nodiscard]] std::size_t sensor_count() const { return sensors_.size(); }
  [[nodiscard]] const SensorInput& sensor(std::size_t i) const { return *sensors_[i]; }
  [[nodiscard]] const MessageFaults& faults() const { return faults_; }
  /// Uses this pose of a camera on a link in place of TF's. `source`: for messages.
  void mount(std::size_t camera, const std::string& parent,
             const Eigen::Isometry3d& T_parent_camera, const std::string& source) {
    cameras_[camera]->mount(parent, T_parent_camera, source);
  }
  /// Returns what is wrong with the robot's messages, one line each.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// Counts a message of a topic with a fault that was found later.
  void add_fault(const std::string& topic, std::int64_t time, const std::string& what) {
    faults_.add(topic, time, what);
  }
  /// Returns the number of messages of each topic, in the order of topics().
  [[nodiscard]] std::span<const std::size_t> received() const { return received_; }

 private:
  template <typename M, typename F>
  [[nodiscard]] MessageHandler handler(std::size_t topic, F take) const;
  [[nodiscard]] MessageHandler handler_of(std::size_t topic);
  [[nodiscard]] MessageHandler handler_of_targets(std::size_t topic);
  [[nodiscard]] MessageHandler handler_of_unused(std::size_t topic);
  template <typename M>
  [[nodiscard]] MessageHandler handler_of_images(std::size_t topic);
  [[nodiscard]] MessageHandler handler_of_video(std::size_t topic);
  template <typename M>
  [[nodiscard]] MessageHandler handler_of_targets_as(std::size_t topic);
  template <typename M>
  [[nodiscard]] MessageHandler handler_of_clouds(std::size_t topic);
  template <typename M>
  [[nodiscard]] MessageHandler handler_of_attached(std::size_t topic);
  template <typename M>
  [[nodiscard]] MessageHandler handler_of_plans(std::size_t topic);
  void take_image(std::size_t topic, KeptImage image, std::int64_t now);
  void take_info(std::size_t topic, const CameraInfoMessage& info, std::int64_t now);
  void follow_robot();
  void note_sensor(std::int64_t stamp, double time_offset, std::int64_t now);
  [[nodiscard]] std::string describe_clocks() const;

  RobotInput robot_;
  std::vector<std::unique_ptr<CameraInput>> cameras_;
  std::vector<std::unique_ptr<CloudInput>> clouds_;
  std::vector<SensorInput*> sensors_;  // all of them
  std::vector<InputTopic> topics_;
  std::vector<MessageHandler> handlers_;  // of each topic
  std::vector<std::size_t> received_;     // likewise
  MessageFaults faults_;
  MessageSources sources_;
  std::optional<std::int64_t> sensor_lag_;  // least time from a stamp to its arrival, nanoseconds
};

}  // namespace penumbra::io
