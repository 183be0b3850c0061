// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// What happens to targets with an identity while they are hidden.
enum class HiddenTargets {
  not_handled,
  predict,  ///< boxes as poses, others as points, each with its filtered velocity
  hold      ///< the last trusted point
};

/// PipelineConfig::target_history for targets of topics: the largest delay of a detector, seconds.
inline constexpr double topic_target_history = 0.5;

/// Makes targets from messages. A target keeps the stamp of its image, so that it is judged on the
/// frame of that stamp even if it comes late.
///
/// A target's name is the topic, "/" and the detection's id, or its best class without an id. Equal
/// names in a message are numbered from the second on ("/detections/person", "/detections/person
/// 2"). A pose has its topic's name. A detection without an id, or whose id is used twice in its
/// message, has no identity: detectors sort by score, so the name goes from object to object.
class TargetInbox {
 public:
  /// Targets that are older than the newest of their topic by more are dropped, nanoseconds: the
  /// frame of their stamp is no longer kept and does not wait for its pose (0.2 s).
  static constexpr std::int64_t longest_lag = 1'000'000'000;
  /// If so many wait, the oldest are dropped before the next message is taken.
  static constexpr std::size_t most_waiting = 1000;

  /// `camera_frame`: of the judged images; `frame_prefix`: stands before link names in frames.
  /// `robot` must outlive this.
  TargetInbox(const Robot& robot, std::string_view camera_frame, std::string_view frame_prefix = {},
              HiddenTargets hidden = HiddenTargets::not_handled);

  /// Returns whether a message's frame is the camera's or, unless it holds pixels, a link's.
  [[nodiscard]] bool knows(std::string_view frame, bool of_pixels) const;

  /// Adds a detector's boxes: regions of the visible part (Extent::modal).
  void add(const std::string& topic, const Detection2DArrayMessage& message);
  /// Adds boxes in the frame of the camera or of a link.
  void add(const std::string& topic, const Detection3DArrayMessage& message);
  void add(const std::string& topic, const KeypointsMessage& message);
  /// Adds a point with a ball of PointTarget::radius around it.
  void add(const std::string& topic, const PoseStampedMessage& message);

  /// Returns the targets for a frame: those of its stamp and earlier, the newest of each name.
  /// Later ones wait for their frame; those of more than longest_lag later are of another clock,
  /// and are returned.
  [[nodiscard]] std::vector<Target> take(std::int64_t frame_stamp);

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  /// Returns how many were never taken because a newer one of their name came first.
  [[nodiscard]] std::size_t replaced() const { return replaced_; }
  /// Returns how many were dropped because they were late or too many.
  [[nodiscard]] std::size_t discarded() const { return discarded_; }

 private:
  struct Waiting {
    std::string_view topic;  // newest_'s
    Target target;
  };

  /// Drops old targets. To be called before a message's targets are added.
  void make_room(const std::string& topic, std::int64_t stamp);
  Target& add_target(std::string name, const MessageHeader& header);
  /// Adds a target for each of a message's detections, named by its id or else by its class; equal
  /// names get numbers.
  template <typename Detection>
  std::vector<Target*> add_targets(const std::string& topic, const MessageHeader& header,
                                   const std::vector<Detection>& detections,
                                   std::string Detection::*id);
  /// Returns the frame of a 3-D target, which is no image frame. Sets its fault if that is neither
  /// the camera's nor a link.
  ReferenceFrame resolve_frame(Target& target) const;

  const Robot& robot_;
  std::string camera_frame_, frame_prefix_;
  HiddenTargets hidden_;
  std::map<std::string, std::int64_t> newest_;  // stamp of each topic
  std::string_view topic_;                      // of the current message, newest_'s
  std::deque<Waiting> waiting_;                 // in the order of arrival
  std::size_t replaced_ = 0, discarded_ = 0;
};

}  // namespace penumbra::io
