// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <io/files/json-inl.hpp>
#include <io/files/printable.hpp>
#include <io/files/statistics.hpp>
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

std::string decimal(double value, const char* unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f%s", value, unit);
  return text.data();
}

std::string seconds_since(std::int64_t then, std::int64_t now) {
  return decimal(static_cast<double>(now - then) * 1e-9, " s");
}

/// Returns why a topic has no messages, or an empty text if the transport gives no reason.
std::string silence_of(const LiveLink& link, const InputTopic& topic) {
  const std::string name = printable(topic.name);
  if (!link.other_type.empty())
    return name + " is of type " + printable(link.other_type) + "; expected " +
           (topic.type.empty() ? "PointCloud2, LaserScan or CustomMsg" : topic.type);
  if (!link.is_open) return name + " is not subscribed to: nobody publishes it yet";
  if (link.publishers > 0) return {};
  if (!link.refused_because.empty())
    return "the publisher of " + name + " offers another QoS (" + link.refused_because +
           ") than requested" +
           (link.refused_because == "reliability" ? "; leave --reliable out" : "");
  return "no publisher of " + name;
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
  return last ? " for " + seconds_since(*last, now) : " yet";
}

void add(Status& status, const std::string& key, const std::string& value) {
  status.values.push_back({key, value});
}
void add_count(Status& status, const std::string& key, std::size_t value) {
  add(status, key, std::to_string(value));
}
void add_quantiles(Status& status, const std::string& key, const LatencyHistogram& times) {
  if (const auto median = times.quantile(0.5))
    add(status, key + " median", decimal(*median, " ms"));
  if (const auto p99 = times.quantile(0.99)) add(status, key + " p99", decimal(*p99, " ms"));
}

void add_link(Status& status, const InputTopic& topic, const LiveLink& link, double rate) {
  std::string text = decimal(rate, " Hz") + ", " + std::to_string(link.publishers) + " publishers";
  if (link.lost > 0) text += ", " + std::to_string(link.lost) + " lost";
  if (link.overwritten > 0) text += ", " + std::to_string(link.overwritten) + " overwritten";
  add(status, printable(topic.name), text);
}

void add_counts(Status& status, const ImageCounts& counts) {
  add_count(status, "received", counts.received);
  add_count(status, "judged", counts.judged);
  add_count(status, "failed", counts.failed);
  for (std::size_t i = 0; i < drop_reasons; ++i)
    if (counts.dropped[i] > 0)
      add_count(status, "dropped: " + std::string(to_string(static_cast<DropReason>(i))),
                counts.dropped[i]);
}

void add_targets(Status& status, const UnjudgedTargets& targets) {
  if (targets.early > 0)
    add_count(status, "target messages before robot and camera were known", targets.early);
  if (targets.replaced > 0)
    add_count(status, "targets not judged: newer ones came first", targets.replaced);
  if (targets.discarded > 0)
    add_count(status, "targets not judged: no image came in time", targets.discarded);
}

void add_tally(Status& status, const LiveTally& tally) {
  for (const auto& [name, frames] : tally.statuses) add_count(status, "frames " + name, frames);
  add_quantiles(status, "stamp to published", tally.latency);
  add_quantiles(status, "arrival to published", tally.processing);
  if (tally.beyond_clock > 0) add_count(status, "stamps of another clock", tally.beyond_clock);
  for (const Stage& stage : stages)
    if (const auto& time = tally.last.timing.*stage.time)
      add(status, "last " + std::string(stage.name), decimal(*time, " ms"));
}

void add_drift(Status& status, const Drift& drift) {
  const Json json = drift_json(drift);
  for (const auto& [key, value] : json.items()) add(status, "calibration " + key, value.dump());
}

/// Adds the renderer, with the names of report.json.
void add_renderer(Status& status, const RendererInfo& renderer) {
  const Json json = renderer_json(renderer);
  for (const auto& [key, value] : json.items())
    if (!value.is_null())
      add(status, "renderer " + key, value.is_string() ? value.get<std::string>() : value.dump());
}

bool is_of_robot(TopicRole role) {
  return role == TopicRole::description || role == TopicRole::joints ||
         role == TopicRole::transforms || role == TopicRole::static_transforms ||
         role == TopicRole::targets || role == TopicRole::attached;
}
bool is_of_camera(TopicRole role) { return !is_of_robot(role) && role != TopicRole::cloud; }

std::string name_of(const CameraInput& camera) {
  const std::string& name = camera.options().name;
  return "camera" + (name.empty() ? "" : " " + name);
}

}  // namespace

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
LiveFault result_fault(const LiveInbox& inbox, const LiveTally& tally,
                       const std::vector<std::string>& warnings, const Arrivals& arrivals,
                       std::span<const LiveLink> links, std::int64_t now) {
  if (!inbox.robot().posed()) {
    const LiveFault robot = robot_fault(inbox, links, now);
    return {Status::error, "nothing can be judged: " + robot.why};
  }
  if (!tally.last.fault.empty()) return {Status::error, tally.last.fault};
  if (!tally.last_published) return {Status::stale, "nothing was judged yet"};
  if (now - *tally.last_published > patience_of(arrivals))
    return {Status::error,
            "nothing was published for " + seconds_since(*tally.last_published, now)};
  if (tally.last.status == FrameStatus::ok)
    return warnings.empty() ? LiveFault() : LiveFault{Status::warn, warnings.front()};
  const std::uint8_t level = has_pose(tally.last.status) ? Status::warn : Status::error;
  return {level, std::string(to_string(tally.last.status)) + ": " + tally.last.message};
}

}  // namespace

LiveFault camera_fault(const LiveInbox& inbox, std::size_t number, std::span<const LiveLink> links,
                       std::int64_t now) {
  const CameraInput& camera = inbox.camera(number);
  const LiveTally& tally = inbox.tally(number);
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
  return result_fault(inbox, tally, inbox.warnings(number), camera.arrivals(), links, now);
}

LiveFault cloud_fault(const LiveInbox& inbox, std::size_t number, std::span<const LiveLink> links,
                      std::int64_t now) {
  const CloudInput& cloud = inbox.cloud(number);
  const CloudTally& tally = inbox.cloud_tally(number);
  if (is_silent(cloud.arrivals(), now))
    return {Status::stale, "no clouds" + since(cloud.arrivals().last(), now) + ": " +
                               why_silent(inbox, TopicRole::cloud, number, links)};
  if (!cloud.setup_fault().empty()) return {Status::error, cloud.setup_fault()};
  const auto unreadable = inbox.faults().all().find(cloud.options().topic);
  if (!tally.last_published && unreadable != inbox.faults().all().end())
    return {Status::error, unreadable->second.what};
  return result_fault(inbox, tally, tally.warnings, cloud.arrivals(), links, now);
}

DiagnosticStatusMessage LiveDiagnostics::make_status(const std::string& subject,
                                                     const LiveFault& fault) const {
  return {.level = fault.level,
          .name = source_.name + ": " + subject,
          .message = fault.why,
          .hardware_id = source_.hardware_id,
          .values = {}};
}

DiagnosticStatusMessage LiveDiagnostics::robot_status(const LiveInbox& inbox,
                                                      std::span<const LiveLink> links,
                                                      const Period& period) const {
  const LiveFault current = robot_fault(inbox, links, period.now);
  Status status = make_status("robot", current);
  if (const auto& posed = inbox.robot().posed()) {
    if (status.message.empty()) status.message = posed->robot.name() + ", its pose is known";
    for (const std::string& line : posed->refusals()) add(status, "note", line);
    for (const std::string& line : posed->robot.notes()) add(status, "note", line);
  }
  add_count(status, "robots received", inbox.robot().robots());
  for (const auto& [topic, fault] : inbox.faults().all())
    add(status, "unreadable in " + printable(topic),
        std::to_string(fault.messages) + ", the first: " + fault.what);
  for (std::size_t i = 0; i < inbox.topics().size(); ++i)
    if (is_of_robot(inbox.topics()[i].role))
      add_link(status, inbox.topics()[i], links[i], rate_of(inbox, i, period));
  return status;
}

DiagnosticStatusMessage LiveDiagnostics::camera_status(const LiveInbox& inbox, std::size_t number,
                                                       std::span<const LiveLink> links,
                                                       const Period& period) const {
  const CameraInput& camera = inbox.camera(number);
  const ImageCounts counts = camera.counts();
  const LiveFault current = camera_fault(inbox, number, links, period.now);
  const double rate = static_cast<double>(counts.judged - judged_[number]) / period.seconds;
  Status status = make_status(name_of(camera), current);
  if (current.why.empty()) status.message = decimal(rate, " frames/s judged");
  add(status, "judged per second", decimal(rate, ""));
  if (camera.setup() != nullptr)
    add(status, "camera on link",
        camera.setup()->mount.parent + ", by " + camera.setup()->mount.source);
  if (const auto& renderer = inbox.tally(number).last.renderer) add_renderer(status, *renderer);
  add_counts(status, counts);
  for (const std::string& line : inbox.warnings(number)) add(status, "warning", line);
  add_drift(status, inbox.tally(number).last.drift);
  add_tally(status, inbox.tally(number));
  if (camera.camera_changes() > 0)
    add_count(status, "camera_info changed", camera.camera_changes());
  add_targets(status, camera.targets());
  for (std::size_t i = 0; i < inbox.topics().size(); ++i)
    if (is_of_camera(inbox.topics()[i].role) && inbox.topics()[i].camera == number)
      add_link(status, inbox.topics()[i], links[i], rate_of(inbox, i, period));
  return status;
}

DiagnosticStatusMessage LiveDiagnostics::cloud_status(const LiveInbox& inbox, std::size_t number,
                                                      std::span<const LiveLink> links,
                                                      const Period& period) const {
  const CloudInput& cloud = inbox.cloud(number);
  const CloudTally& tally = inbox.cloud_tally(number);
  const ImageCounts counts = cloud.counts();
  const LiveFault current = cloud_fault(inbox, number, links, period.now);
  const double rate = static_cast<double>(counts.judged - labelled_[number]) / period.seconds;
  Status status = make_status("cloud " + printable(cloud.options().topic), current);
  if (current.why.empty()) status.message = decimal(rate, " clouds/s labelled");
  add(status, "labelled per second", decimal(rate, ""));
  if (cloud.setup() != nullptr)
    add(status, "sensor on link",
        cloud.setup()->mount.parent + ", by " + cloud.setup()->mount.source);
  add_counts(status, counts);
  for (const std::string& line : tally.warnings) add(status, "warning", line);
  for (std::size_t i = 0; i < label_count; ++i)
    add_count(status, "points " + std::string(point_label_names[i]), tally.all.points[i]);
  add_count(status, "most poses of a scan", tally.all.parts);
  if (!tally.all.time_note.empty()) add(status, "times", tally.all.time_note);
  if (cloud.late_targets() > 0)
    add_count(status, "targets not judged: no cloud has their stamp", cloud.late_targets());
  add_tally(status, tally);
  for_each_topic(inbox, TopicRole::cloud, number, [&](std::size_t i) {
    add_link(status, inbox.topics()[i], links[i], rate_of(inbox, i, period));
  });
  return status;
}

double LiveDiagnostics::rate_of(const LiveInbox& inbox, std::size_t topic,
                                const Period& period) const {
  return static_cast<double>(inbox.received()[topic] - received_[topic]) / period.seconds;
}

DiagnosticArrayMessage LiveDiagnostics::report(const LiveInbox& inbox,
                                               std::span<const LiveLink> links,
                                               const LiveMoment& moment) {
  const Period period{moment.now, std::max(static_cast<double>(moment.now - before_) * 1e-9, 1e-3)};
  judged_.resize(inbox.camera_count());
  received_.resize(inbox.topics().size());
  DiagnosticArrayMessage array{.header = {moment.system_now, ""}, .status = {}};
  array.status.push_back(robot_status(inbox, links, period));
  for (std::size_t c = 0; c < inbox.camera_count(); ++c) {
    array.status.push_back(camera_status(inbox, c, links, period));
    judged_[c] = inbox.camera(c).counts().judged;
  }
  labelled_.resize(inbox.cloud_count());
  for (std::size_t c = 0; c < inbox.cloud_count(); ++c) {
    array.status.push_back(cloud_status(inbox, c, links, period));
    labelled_[c] = inbox.cloud(c).counts().judged;
  }
  received_.assign(inbox.received().begin(), inbox.received().end());
  before_ = moment.now;
  return array;
}

}  // namespace penumbra::io
