// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <span>
#include <string>
#include <string_view>
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
class TargetInbox {
 public:
  /// `camera_frame`: of the judged images. `robot` must outlive this.
  TargetInbox(const Robot& robot, std::string_view camera_frame);

  /// A detector's boxes: regions of what it sees (Extent::modal).
  void add(const std::string& topic, const Detection2DArrayMessage& message);
  /// Boxes in the camera's frame or in that of a link.
  void add(const std::string& topic, const Detection3DArrayMessage& message);
  void add(const std::string& topic, const KeypointsMessage& message);
  /// A point with a ball of PointTarget::radius around it.
  void add(const std::string& topic, const PoseStampedMessage& message);

  /// What was told since the last call; of one name the newest. Valid until the next call.
  [[nodiscard]] std::span<const Target> take();

  [[nodiscard]] std::size_t waiting() const { return told_.size(); }
  /// How many were never given, as a newer one of their name came first.
  [[nodiscard]] std::size_t replaced() const { return replaced_; }

 private:
  /// A target and what it refers to; stays where it is.
  struct Told {
    std::string name, image_frame, link_frame, fault;
    std::vector<Eigen::Vector2d> corners;
    Target target;
  };

  /// What a name is made of, without its number.
  struct Label {
    std::string text;
    bool is_id = false;
  };

  Told& told(std::string name, const MessageHeader& header);
  /// The same for each of a message's detections.
  std::vector<Told*> told(const std::vector<Label>& labels, const MessageHeader& header);
  /// Of a 3-D target: the link that its frame is, or the camera.
  LinkFrame frame_of(Told& told) const;
  static Label label_of(const std::string& topic, const std::string& id,
                        std::span<const HypothesisMessage> results);

  const Robot& robot_;
  std::string camera_frame_;
  std::list<Told> told_;   // since the last call
  std::list<Told> given_;  // what targets_ refer to
  std::vector<Target> targets_;
  std::size_t replaced_ = 0;
};

}  // namespace penumbra::io
