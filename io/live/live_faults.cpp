// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <penumbra/base/stamps.hpp>

#include <io/assembly/judged_cameras.hpp>
#include <io/files/printable.hpp>
#include <io/live/live_diagnostics.hpp>

namespace penumbra::io {
namespace {

using Status = DiagnosticStatusMessage;

/// A stream has stopped after this time without a message, in nanoseconds. Images are also given
/// this number of their own periods.
constexpr std::int64_t silence = 1'000'000'000;
constexpr std::int64_t periods_awaited = 2;

/// Fewer consecutive images without camera_info are not reported: one may be lost.
constexpr std::size_t least_without_info = 3;

std::string seconds(std::uint64_t nanoseconds) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", static_cast<double>(nanoseconds) * 1e-9);
  return text.data();
}

/// Returns why a topic has no messages, or an empty text if the transport gives no reason.
std::string silence_of(const LiveLink& link, const InputTopic& topic) {
  const std::string name = printable(topic.name);
  if (!link.other_type.empty())
    return name + " is of type " + printable(link.other_type) + "; expected " +
           (topic.type.empty() ? "PointCloud2, LaserScan or CustomMsg" : topic.type);
  const std::string other =
      link.other_topic.empty() ? "" : ", but of " + printable(link.other_topic) + ": name that one";
  if (!link.is_open) return name + " is not subscribed to: nobody publishes it yet" + other;
  if (link.publishers > 0) return {};
  if (!link.refused_because.empty())
    return "the publisher of " + name + " offers another QoS (" + link.refused_because +
           ") than requested" +
           (link.refused_because == "reliability" ? "; leave --reliable out" : "");
  return "no publisher of " + name + other;
}

/// Calls `call` with the index of each topic of a role and camera.
template <typename F>
void for_each_topic(const LiveInbox& inbox, TopicRole role, std::size_t camera, const F& call) {
  for (std::size_t i = 0; i < inbox.topics().size(); ++i)
    if (inbox.topics()[i].role == role && inbox.topics()[i].camera == camera) call(i);
}

std::string why_silent(const LiveInbox& inbox, TopicRole role, std::size_t camera,
                       std::span<const LiveLink> links) {
  std::string why;
  for_each_topic(inbox, role, camera, [&](std::size_t i) {
    const std::string one = silence_of(links[i], inbox.topics()[i]);
    if (!one.empty()) why += (why.empty() ? "" : "; ") + one;
    const MessageFaults& faults = inbox.faults();
    const auto fault = faults.all().find(inbox.topics()[i].name);
    if (one.empty() && fault != faults.all().end())
      why += (why.empty() ? "" : "; ") + std::to_string(fault->second.messages) +
             " messages cannot be read: " + fault->second.what;
  });
  return why.empty() ? "its publisher sends nothing" : why;
}

std::string since(const std::optional<std::int64_t>& last, std::int64_t now) {
  return last ? " for " + seconds(stamp_distance(*last, now)) : " yet";
}

/// Returns the joints that move drawn links and had no state yet, and what was received in their
/// place.
JointAnswer joints_never_seen(const PosedRobot& posed) {
  const Robot& robot = posed.robot;
  std::vector<bool> carries(robot.links().size()), is_needed(robot.variables().size());
  for (std::size_t link = robot.links().size(); link-- > 1;) {  // children come after parents
    const Joint& joint = robot.joints()[link - 1];
    carries[link] = carries[link] || robot.report()[link].drawn;
    carries[joint.parent] = carries[joint.parent] || carries[link];
    if (carries[link] && joint.variable) is_needed[*joint.variable] = true;
  }
  JointAnswer answer;
  posed.history.joints().at(0, answer);
  std::erase_if(answer.gaps, [&](const JointGap& gap) {
    return gap.why != JointStatus::missing || !is_needed[gap.variable];
  });
  return answer;
}

/// Returns what is wrong with the stamps of joint states that arrive, or nothing. `stamp`: of the
/// last image.
std::string stamps_differ(const RobotInput& robot, std::int64_t stamp, std::int64_t now) {
  const auto newest = robot.posed()->history.joints().newest_of(robot.posed()->robot.variables());
  const auto& used = robot.last_used_joints();
  if (!newest || !used || now - *used > silence) return {};
  if (stamp_distance(*newest, stamp) <= std::uint64_t{least_clock_jump}) return {};
  return std::string("; the stamps of joint states are ") +
         seconds(stamp_distance(*newest, stamp)) + (*newest > stamp ? " later" : " earlier") +
         " than those of the sensor: a clock was set back, or stamps are frozen";
}

/// Returns what is wrong with the stamps of a sensor's messages that are dropped, or nothing.
std::string dropped_because(const ImageCounts& counts) {
  if (counts.last_dropped == DropReason::no_stamp) return ": their stamps are 0";
  if (counts.last_dropped == DropReason::late)
    return ": their stamps do not grow: they are frozen, or a clock was set back";
  return {};
}

/// Returns "TROUBLE (ok in 92 % of the frames of the last 10 s)".
std::string with_share(const LiveTally& tally) {
  const auto ok =
      std::ranges::count_if(tally.recent, [](const auto& frame) { return frame.second; });
  const auto percent = 100 * static_cast<std::size_t>(ok) / tally.recent.size();
  return tally.last_trouble + " (ok in " + std::to_string(percent) +
         " % of the frames of the last " + std::to_string(LiveTally::recent_time / 1'000'000'000) +
         " s)";
}

}  // namespace

std::string other_topic(const InputTopic& topic,
                        const std::function<bool(const std::string&)>& is_published) {
  if (topic.role != TopicRole::depth && topic.role != TopicRole::color) return {};
  const std::string base = image_base(topic.name);
  for (const char* transport : {"", "/compressedDepth", "/compressed"})
    if (base + transport != topic.name && is_published(base + transport)) return base + transport;
  return {};
}

LiveFault robot_fault(const LiveInbox& inbox, std::span<const LiveLink> links, std::int64_t now) {
  const RobotInput& robot = inbox.robot();
  if (!robot.fault().empty()) return {Status::error, robot.fault()};
  if (robot.is_being_made())
    return {Status::stale, "the robot of the robot_description is being made: its meshes are read"};
  if (!robot.posed())
    return {Status::stale,
            "no robot_description yet: " + why_silent(inbox, TopicRole::description, 0, links)};
  const bool by_joints = inbox.options().poses != PoseSource::transforms;
  if (by_joints && robot.posed()->robot.variables().empty()) return {};
  const auto& last = by_joints ? robot.last_joints() : robot.last_transforms();
  if (!last || now - *last > silence)
    return {Status::stale,
            std::string(by_joints ? "no joint states" : "no tf") + since(last, now) + ": " +
                why_silent(inbox, by_joints ? TopicRole::joints : TopicRole::transforms, 0, links)};
  const auto& used = robot.last_used_joints();
  if (by_joints && (!used || now - *used > silence))
    return {Status::error, "no joint states of the robot" + since(used, now) + ": " +
                               (robot.unused_joints().empty() ? "none came since the robot is known"
                                                              : robot.unused_joints())};
  if (const JointAnswer lacking = joints_never_seen(*robot.posed());
      by_joints && !lacking.gaps.empty())
    return {Status::error, "joint states arrive, but " + describe(robot.posed()->robot, lacking) +
                               remedy_of(robot.posed()->robot, lacking)};
  return {};
}

namespace {

std::int64_t patience_of(const Arrivals& arrivals) {
  return silence + periods_awaited * arrivals.period().value_or(0);
}

bool is_silent(const Arrivals& arrivals, std::int64_t now) {
  return !arrivals.last() || now - *arrivals.last() > patience_of(arrivals);
}

/// Returns why messages that arrive give no result, or what is wrong with the results.
LiveFault result_fault(const LiveInbox& inbox, std::size_t number, std::span<const LiveLink> links,
                       std::int64_t now) {
  const SensorInput& sensor = inbox.sensor(number);
  const LiveTally& tally = inbox.tally(number);
  const std::vector<std::string> warnings = inbox.warnings(number);
  if (!inbox.robot().posed()) {
    const LiveFault robot = robot_fault(inbox, links, now);
    return {Status::error, "nothing can be judged: " + robot.why};
  }
  if (!tally.last.fault.empty()) return {Status::error, tally.last.fault};
  if (!tally.last_published)
    return {Status::stale, "nothing was judged yet" + dropped_because(sensor.counts())};
  if (now - *tally.last_published > patience_of(sensor.arrivals()))
    return {Status::error, "nothing was published for " +
                               seconds(stamp_distance(*tally.last_published, now)) +
                               dropped_because(sensor.counts())};
  if (std::ranges::all_of(tally.recent, [](const auto& frame) { return frame.second; }))
    return warnings.empty() ? LiveFault() : LiveFault{Status::warn, warnings.front()};
  std::string why = with_share(tally);
  if (has_pose(tally.last.status)) return {Status::warn, why};
  return {Status::error, why + stamps_differ(inbox.robot(), tally.last.stamp, now)};
}

}  // namespace

LiveFault camera_fault(const LiveInbox& inbox, std::size_t number, std::span<const LiveLink> links,
                       std::int64_t now) {
  const CameraInput& camera = inbox.camera(number);
  if (is_silent(camera.arrivals(), now))
    return {Status::stale, "no depth images" + since(camera.arrivals().last(), now) + ": " +
                               why_silent(inbox, TopicRole::depth, number, links)};
  if (!camera.has_info())
    return {Status::error,
            "no camera_info yet: " + why_silent(inbox, TopicRole::camera_info, number, links)};
  if (camera.lacks_color_info())
    return {Status::error, "no camera_info of the color images yet: " +
                               why_silent(inbox, TopicRole::color_info, number, links)};
  if (!camera.setup_fault().empty()) return {Status::error, camera.setup_fault()};
  if (camera.without_info() >= least_without_info)
    return {Status::error,
            std::to_string(camera.without_info()) +
                " images are not judged: they have no camera_info of their stamp. It is late or "
                "lost, or they are another camera's: " +
                why_silent(inbox, TopicRole::camera_info, number, links)};
  return result_fault(inbox, number, links, now);
}

LiveFault cloud_fault(const LiveInbox& inbox, std::size_t number, std::span<const LiveLink> links,
                      std::int64_t now) {
  const CloudInput& cloud = inbox.cloud(number);
  const LiveTally& tally = inbox.tally(inbox.camera_count() + number);
  if (is_silent(cloud.arrivals(), now))
    return {Status::stale, "no clouds" + since(cloud.arrivals().last(), now) + ": " +
                               why_silent(inbox, TopicRole::cloud, number, links)};
  if (!cloud.setup_fault().empty()) return {Status::error, cloud.setup_fault()};
  const auto unreadable = inbox.faults().all().find(cloud.options().topic);
  if (!tally.last_published && unreadable != inbox.faults().all().end())
    return {Status::error, unreadable->second.what};
  return result_fault(inbox, inbox.camera_count() + number, links, now);
}

}  // namespace penumbra::io
