// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <io/cloud/cloud_json-inl.hpp>
#include <io/cloud/cloud_summary.hpp>

namespace penumbra::io {

void CloudSummary::add(const CloudReport& report, const std::string& fault, double elapsed) {
  ++clouds;
  ++statuses[report.status];
  messages.emplace(report.status, fault.empty() ? report.message : fault);
  if (body_note.empty()) body_note = report.note;
  for (const TargetReport& target : report.targets)
    if (target_note.empty()) target_note = target.note;
  not_handled += std::ranges::any_of(report.targets, &TargetReport::wants_stamp) ? 1 : 0;
  for (std::size_t i = 0; i < label_count; ++i) points[i] += report.points[i];
  parts = std::max(parts, report.parts);
  milliseconds += elapsed;
}

std::size_t CloudSummary::labelled() const {
  std::size_t count = 0;
  for (const auto& [status, of] : statuses)
    if (status == FrameStatus::ok || status == FrameStatus::missing_link) count += of;
  return count;
}

std::vector<std::string> CloudSummary::warnings() const {
  std::vector<std::string> lines;
  for (const std::string& note : {body_note, target_note})
    if (!note.empty()) lines.push_back(note);
  if (not_handled > 0)
    lines.push_back("targets that want handling in " + std::to_string(not_handled) +
                    " clouds without a stamp: they are not handled there");
  const auto of = [&](Label label) {
    return static_cast<double>(points[static_cast<std::size_t>(label)]);
  };
  const double on_robot = of(Label::occluded) + of(Label::beyond);
  if (labelled() == 0) return lines;
  if (on_robot == 0.0)
    lines.emplace_back(
        "no point is on the robot: it is out of the sensor's view, or the sensor's pose is wrong");
  constexpr double likely_wrong = 0.1;
  if (const double share = of(Label::beyond) / on_robot; share > likely_wrong)
    lines.push_back(std::to_string(std::lround(100.0 * share)) +
                    " % of the points in the robot's direction lie behind it, which no sensor can "
                    "see: the sensor's pose, the joint positions or their stamps are wrong, or the "
                    "model is larger than the robot");
  return lines;
}

std::vector<std::string> CloudSummary::notes() const {
  std::vector<std::string> lines;
  for (const auto& [status, of] : statuses)
    if (status != FrameStatus::ok)
      lines.push_back(name + ": " + std::to_string(of) + " of " + std::to_string(clouds) +
                      " clouds are " + std::string(to_string(status)) +
                      ", the first: " + messages.at(status));
  for (const std::string& line : warnings()) lines.push_back(name + ": " + line);
  return lines;
}

Json counts_by_label(const std::array<std::size_t, label_count>& points) {
  Json counts;
  for (std::size_t i = 0; i < label_count; ++i)
    counts[std::string(point_label_names[i])] = points[i];
  return counts;
}

Json cloud_summary_json(const CloudSummary& summary) {
  Json faults = Json::array();
  for (const auto& [status, clouds] : summary.statuses)
    if (status != FrameStatus::ok)
      faults.push_back({{"status", to_string(status)},
                        {"clouds", clouds},
                        {"first_message", summary.messages.at(status)}});
  return {{"clouds", summary.clouds},
          {"labelled", summary.labelled()},
          {"points", counts_by_label(summary.points)},
          {"faults", std::move(faults)},
          {"notes", summary.notes()}};
}

Json cloud_frame_json(const CloudReport& report, std::uint64_t index, const std::string& fault) {
  Json targets = Json::array();
  for (const TargetReport& target : report.targets) targets.push_back(target_json(target));
  return {{"index", index},
          {"stamp_ns", or_null(report.stamp)},
          {"status", to_string(report.status)},
          {"message", or_null(fault.empty() ? report.message : fault)},
          {"parts", report.parts},
          {"points", counts_by_label(report.points)},
          {"targets", std::move(targets)}};
}

}  // namespace penumbra::io
