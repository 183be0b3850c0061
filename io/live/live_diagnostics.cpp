// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <regex>
#include <utility>

#include <penumbra/time/source_tracks.hpp>

#include <io/files/json.hpp>
#include <io/files/printable.hpp>
#include <io/files/statistics.hpp>
#include <io/live/live_diagnostics.hpp>

namespace penumbra::io {
namespace {

using Status = DiagnosticStatusMessage;

std::string decimal(double value, const char* unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f%s", value, unit);
  return text.data();
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

void add_targets(Status& status, const ImageCounts& counts) {
  if (counts.early_targets > 0)
    add_count(status, "target messages before robot and sensor were known", counts.early_targets);
  if (counts.targets_replaced > 0)
    add_count(status, "targets not judged: newer ones came first", counts.targets_replaced);
  if (counts.targets_discarded > 0)
    add_count(status, "targets not judged: no frame came in time", counts.targets_discarded);
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

void add_points(Status& status, const LiveTally& tally) {
  for (const auto& [label, count] : point_counts)
    add_count(status, "points " + std::string(label), tally.points.*count);
  add_count(status, "most poses of a scan", tally.parts);
  if (!tally.time_note.empty()) add(status, "times", tally.time_note);
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

/// Replaces names of options by those of parameters.
std::string LiveDiagnostics::in_own_words(const std::string& text) const {
  static const std::regex option("--([a-z]+(-[a-z]+)*)");
  std::string words;
  auto end = text.begin();
  for (auto found = std::sregex_iterator(text.begin(), text.end(), option);
       found != std::sregex_iterator(); ++found) {
    std::string name = (*found)[1];
    std::ranges::replace(name, '-', '_');
    words.append(end, (*found)[0].first);
    if (!source_.parameters.contains(name)) name += 's';  // as packages for --package
    words += source_.parameters.contains(name) ? name : std::string((*found)[0]);
    end = (*found)[0].second;
  }
  words.append(end, text.end());
  if (words.find(others_unused) != std::string::npos) words += "; " + source_.how_to_forget;
  return words;
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
                                                      const Period& period) {
  LiveFault current = robot_fault(inbox, links, period.now);
  const auto& posed = inbox.robot().posed();
  const std::size_t jumps = posed ? posed->history.clock_jumps() : 0;
  if (current.why.empty() && jumps > jumps_) current = {Status::warn, posed->history.last_jump()};
  jumps_ = jumps;
  Status status = make_status("robot", current);
  if (posed) {
    if (status.message.empty()) status.message = posed->robot.name() + ", its pose is known";
    for (const std::string& line : posed->refusals()) add(status, "note", line);
    if (posed->history.transforms().refused() > 0) add(status, "note", source_.how_to_forget);
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

DiagnosticStatusMessage LiveDiagnostics::sensor_status(const LiveInbox& inbox, std::size_t sensor,
                                                       std::span<const LiveLink> links,
                                                       const Period& period) const {
  const bool is_camera = sensor < inbox.camera_count();
  const std::size_t number = is_camera ? sensor : sensor - inbox.camera_count();
  const SensorInput& input = inbox.sensor(sensor);
  const LiveTally& tally = inbox.tally(sensor);
  const ImageCounts counts = input.counts();
  const LiveFault current = is_camera ? camera_fault(inbox, number, links, period.now)
                                      : cloud_fault(inbox, number, links, period.now);
  const double rate = static_cast<double>(counts.judged - judged_[sensor]) / period.seconds;
  Status status = make_status(is_camera ? name_of(inbox.camera(number))
                                        : "cloud " + printable(inbox.cloud(number).options().topic),
                              current);
  if (current.why.empty())
    status.message = decimal(rate, is_camera ? " frames/s judged" : " clouds/s labelled");
  add(status, is_camera ? "judged per second" : "labelled per second", decimal(rate, ""));
  if (const SensorSetup* const setup = input.setup())
    add(status, is_camera ? "camera on link" : "sensor on link",
        setup->mount.parent + ", by " + setup->mount.source);
  if (tally.last.renderer) add_renderer(status, *tally.last.renderer);
  add_counts(status, counts);
  for (const std::string& line : inbox.warnings(sensor)) add(status, "warning", line);
  if (is_camera)
    add_drift(status, tally.last.drift);
  else
    add_points(status, tally);
  add_tally(status, tally);
  if (is_camera && inbox.camera(number).camera_changes() > 0)
    add_count(status, "camera_info changed", inbox.camera(number).camera_changes());
  add_targets(status, counts);
  for (std::size_t i = 0; i < inbox.topics().size(); ++i) {
    const InputTopic& topic = inbox.topics()[i];
    const bool is_own = is_camera ? is_of_camera(topic.role) : topic.role == TopicRole::cloud;
    if (is_own && topic.camera == number)
      add_link(status, topic, links[i], rate_of(inbox, i, period));
  }
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
  judged_.resize(inbox.sensor_count());
  received_.resize(inbox.topics().size());
  DiagnosticArrayMessage array{.header = {moment.system_now, ""}, .status = {}};
  array.status.push_back(robot_status(inbox, links, period));
  for (std::size_t i = 0; i < inbox.sensor_count(); ++i)
    array.status.push_back(sensor_status(inbox, i, links, period));
  for (std::size_t i = 0; i < judged_.size(); ++i) judged_[i] = inbox.sensor(i).counts().judged;
  received_.assign(inbox.received().begin(), inbox.received().end());
  before_ = moment.now;
  for (Status& status : array.status) {
    status.message = in_own_words(status.message);
    for (auto& [key, value] : status.values) value = in_own_words(value);
  }
  return array;
}

}  // namespace penumbra::io
