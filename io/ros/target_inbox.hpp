// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <penumbra/pipeline/target.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Makes targets of messages. Each keeps the stamp of its image, so that it is judged on the frame
/// of that stamp however late it comes.
///
/// Names: the topic, "/" and a detection's id; without ids its best class, numbered from the second
/// of a message on ("/detections/person", "/detections/person 2"). A pose has its topic's name.
/// What has no id, or one that is there twice in its message, has no identity: detectors sort by
/// score, so that such a name goes from object to object.
///
/// What is not taken does not pile up: see longest_lag and most_waiting.
class TargetInbox {
 public:
  /// Targets that lag behind the newest of their topic by more are dropped, nanoseconds: the frame
  /// of their stamp is no longer kept, nor does it wait for its pose (0.5 s and 0.2 s).
  static constexpr std::int64_t longest_lag = 1'000'000'000;
  /// With so many waiting, the oldest are dropped before a message is added.
  static constexpr std::size_t most_waiting = 1000;

  /// `camera_frame`: of the judged images; `frame_prefix`: before link names in frames. `robot`
  /// must outlive this.
  TargetInbox(const Robot& robot, std::string_view camera_frame,
              std::string_view frame_prefix = {});

  /// A detector's boxes: regions of what it sees (Extent::modal).
  void add(const std::string& topic, const Detection2DArrayMessage& message);
  /// Boxes in the camera's frame or in that of a link.
  void add(const std::string& topic, const Detection3DArrayMessage& message);
  void add(const std::string& topic, const KeypointsMessage& message);
  /// A point with a ball of PointTarget::radius around it.
  void add(const std::string& topic, const PoseStampedMessage& message);

  /// Returns the newest target of each name since the last call. Valid until the next call.
  [[nodiscard]] std::span<const Target> take();

  [[nodiscard]] std::size_t waiting() const { return received_.size(); }
  /// How many were never given, as a newer one of their name came first.
  [[nodiscard]] std::size_t replaced() const { return replaced_; }
  /// How many were never given, as they lagged behind or were too many.
  [[nodiscard]] std::size_t discarded() const { return discarded_; }

 private:
  /// A target and the data that it refers to; its address is stable.
  struct Received {
    std::string_view topic;  // newest_'s
    std::string name, image_frame, link_frame, fault;
    std::vector<Eigen::Vector2d> corners;
    Target target;
  };

  /// What a name is made of, without its number.
  struct Label {
    std::string text;
    bool is_id = false;
  };

  using List = std::list<Received>;

  /// Drops outdated targets; called before those of a message are added.
  void make_room(const std::string& topic, std::int64_t stamp);
  List::iterator forget(List::iterator one);
  Received& receive(std::string name, const MessageHeader& header);
  /// Adds a target for each of a message's detections.
  std::vector<Received*> receive(const std::vector<Label>& labels, const MessageHeader& header);
  /// Returns the reference frame of a 3-D target.
  ReferenceFrame frame_of(Received& received) const;
  static Label label_of(const std::string& topic, const std::string& id,
                        std::span<const HypothesisMessage> results);

  const Robot& robot_;
  std::string camera_frame_, frame_prefix_;
  std::map<std::string, std::int64_t> newest_;  // stamp of each topic
  std::string_view topic_;                      // whose message is taken, newest_'s
  List received_;                               // since the last call
  std::unordered_map<std::string_view, List::iterator> by_name_;  // in received_
  List given_;                                                    // what targets_ refer to
  std::vector<Target> targets_;
  std::size_t replaced_ = 0, discarded_ = 0;
};

}  // namespace penumbra::io
