// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <penumbra/base/stamps.hpp>

#include <io/files/printable.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {
namespace {

std::string_view without_slash(std::string_view frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

/// Returns the class with the highest score; empty if there is none.
std::string best_class(std::span<const HypothesisMessage> results) {
  const auto best = std::max_element(results.begin(), results.end(),
                                     [](const HypothesisMessage& a, const HypothesisMessage& b) {
                                       return a.hypothesis.score < b.hypothesis.score;
                                     });
  return best == results.end() ? std::string() : best->hypothesis.class_id;
}

TargetHandling handling_of(const TargetShape& shape, HiddenTargets hidden) {
  if (hidden == HiddenTargets::not_handled) return {};
  if (hidden == HiddenTargets::hold) return PointTrackerConfig();
  if (std::holds_alternative<BoxTarget>(shape)) return PoseTrackerConfig();
  return PointTrackerConfig{.motion = PointMotion::constant_velocity};
}

/// Detectors count from the edge of the first pixel, regions from its centre.
Region region_of(const BoundingBox2D& box) {
  const Eigen::Vector2d centre = box.centre.position - Eigen::Vector2d(0.5, 0.5);
  const Eigen::Vector2d half(box.size_x / 2, box.size_y / 2);
  if (box.centre.theta == 0)
    return PixelBox{centre.x() - half.x(), centre.y() - half.y(), box.size_x, box.size_y};
  const Eigen::Rotation2Dd turn(box.centre.theta);
  PixelPolygon outline;
  for (const auto& [x, y] :
       std::array<std::array<double, 2>, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}})
    outline.corners.push_back(centre + turn * Eigen::Vector2d(x * half.x(), y * half.y()));
  return outline;
}

}  // namespace

TargetInbox::TargetInbox(const Robot& robot, std::string_view camera_frame,
                         std::string_view frame_prefix, HiddenTargets hidden)
    : robot_(robot), camera_frame_(camera_frame), frame_prefix_(frame_prefix), hidden_(hidden) {}

void TargetInbox::make_room(const std::string& topic, std::int64_t stamp) {
  const auto found = newest_.try_emplace(topic, stamp).first;
  topic_ = found->first;
  std::int64_t& newest = found->second;
  // A stamp older than any late target's means that the clock was set back: begin again from it.
  if (stamp > 0) newest = stamp < newest - longest_lag ? stamp : std::max(newest, stamp);
  discarded_ += std::erase_if(waiting_, [&](const Waiting& one) {
    return one.topic == topic_ && one.target.stamp > 0 && *one.target.stamp < newest - longest_lag;
  });
  for (; waiting_.size() >= most_waiting; ++discarded_) waiting_.pop_front();
}

Target& TargetInbox::add_target(std::string name, const MessageHeader& header) {
  Waiting& waiting = waiting_.emplace_back();
  waiting.topic = topic_;
  Target& target = waiting.target;
  target.name = std::move(name);
  target.frame_id = without_slash(header.frame_id);
  target.stamp = header.stamp;
  if (header.stamp <= 0) target.fault = "its message has no stamp";
  if (target.frame_id.empty()) target.fault = "its message does not name its frame";
  return target;
}

template <typename Detection>
std::vector<Target*> TargetInbox::add_targets(const std::string& topic, const MessageHeader& header,
                                              const std::vector<Detection>& detections,
                                              std::string Detection::*id) {
  make_room(topic, header.stamp);
  std::vector<std::string> names;
  for (const Detection& detection : detections) {
    std::string name = detection.*id;
    if constexpr (requires { detection.results; })
      if (name.empty()) name = best_class(detection.results);
    names.push_back(without_controls(topic + "/" + name));
  }
  std::unordered_map<std::string_view, std::size_t> uses;
  for (const std::string& base : names) ++uses[base];
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string_view, int> last;
  std::vector<Target*> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& base = names[i];
    std::string name = base;
    for (int& n = last.try_emplace(base, 1).first->second; !taken.insert(name).second;)
      name = base + " " + std::to_string(++n);
    all.push_back(&add_target(name, header));
    all.back()->has_identity = !(detections[i].*id).empty() && uses[base] == 1 && name == base;
  }
  return all;
}

void TargetInbox::add(const std::string& topic, const Detection2DArrayMessage& message) {
  const std::vector<Target*> all =
      add_targets(topic, message.header, message.detections, &Detection2DMessage::id);
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& shape = all[i]->shape.emplace<RegionTarget>();
    shape.region = region_of(message.detections[i].bbox);
    shape.extent = Extent::modal;
  }
}

void TargetInbox::add(const std::string& topic, const Detection3DArrayMessage& message) {
  const std::vector<Target*> all =
      add_targets(topic, message.header, message.detections, &Detection3DMessage::id);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const BoundingBox3D& box = message.detections[i].bbox;
    const ReferenceFrame frame = resolve_frame(*all[i]);
    all[i]->shape = BoxTarget{.pose = box.centre, .size = box.size, .frame = frame};
  }
}

void TargetInbox::add(const std::string& topic, const KeypointsMessage& message) {
  const std::vector<Target*> all =
      add_targets(topic, message.header, message.keypoints, &KeypointMessage::name);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const KeypointMessage& keypoint = message.keypoints[i];
    KeypointTarget shape{.pixel = {keypoint.u, keypoint.v}, .score = keypoint.score};
    if (keypoint.depth > 0) shape.expected_depth = keypoint.depth;
    all[i]->shape = shape;
  }
}

void TargetInbox::add(const std::string& topic, const PoseStampedMessage& message) {
  make_room(topic, message.header.stamp);
  Target& one = add_target(topic, message.header);
  const ReferenceFrame frame = resolve_frame(one);
  one.shape = PointTarget{.position = message.pose.translation(), .frame = frame};
}

bool TargetInbox::knows(std::string_view frame, bool of_pixels) const {
  frame = without_slash(frame);
  if (frame == without_slash(camera_frame_)) return true;
  return !of_pixels && frame.starts_with(frame_prefix_) &&
         robot_.find_link(frame.substr(frame_prefix_.size()));
}

ReferenceFrame TargetInbox::resolve_frame(Target& target) const {
  const std::string frame = std::exchange(target.frame_id, {});
  if (frame.empty() || frame == without_slash(camera_frame_)) return {};
  if (!knows(frame, false))
    target.fault =
        "its frame '" + printable(frame) + "' is neither the camera's nor a link of the robot";
  return ReferenceFrame::of_link(
      frame.starts_with(frame_prefix_) ? frame.substr(frame_prefix_.size()) : frame);
}

std::vector<Target> TargetInbox::take(std::int64_t frame_stamp) {
  std::deque<Waiting> due = std::exchange(waiting_, {});
  const auto waits = [&](const Waiting& one) {
    const std::int64_t stamp = one.target.stamp.value_or(0);
    return stamp > frame_stamp && stamp_distance(stamp, frame_stamp) <= longest_lag;
  };
  const auto later = std::stable_partition(due.begin(), due.end(), std::not_fn(waits));
  std::move(later, due.end(), std::back_inserter(waiting_));
  due.erase(later, due.end());
  std::vector<Target> targets;
  std::unordered_map<std::string, std::size_t> places;
  for (Waiting& waiting : due) {
    Target& target = waiting.target;
    // Only pixels have an image frame. The camera's name is compared as it stands.
    if (!target.frame_id.empty() && target.frame_id == without_slash(camera_frame_))
      target.frame_id = camera_frame_;
    if (target.has_identity) target.handling = handling_of(target.shape, hidden_);
    const auto [known, is_new] = places.try_emplace(target.name, targets.size());
    if (is_new)
      targets.push_back(std::move(target));
    else
      targets[known->second] = std::move(target);
    replaced_ += is_new ? 0 : 1;
  }
  return targets;
}

}  // namespace penumbra::io
