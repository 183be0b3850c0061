// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <penumbra/base/version.hpp>

#include <io/files/json.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::io {

Json intervals_json(std::span<const VerdictInterval> intervals) {
  Json all = Json::array();
  for (const VerdictInterval& each : intervals)
    all.push_back({{"begin_s", each.begin},
                   {"end_s", each.end},
                   {"verdict", to_string(each.verdict)},
                   {"hidden", each.hidden},
                   {"by", or_null(each.by)},
                   {"reason", or_null(each.reason)}});
  return all;
}
namespace {

constexpr std::size_t write_size = std::size_t{1} << 16;  // bytes gathered before they are written
constexpr double ns_per_ms = 1e6;

/// Replaces bytes that are not UTF-8, which names from files may hold.
std::string dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json list(std::span<const std::string> names) {
  Json array = Json::array();
  for (const std::string& name : names) array.push_back(name);
  return array;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Vector>
Json vector_json(const Vector& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

Json blame_json(const Judgement& judgement) {
  Json blame = Json::array();
  for (const Blame& one : judgement.blame)
    blame.push_back({{"link", one.name}, {"fraction", one.fraction}});
  return blame;
}

Json handled_json(const std::optional<HandledTarget>& handled) {
  if (!handled) return nullptr;
  Json json = {{"source", to_string(handled->source)},
               {"age_s", finite_or_null(handled->age)},
               {"position", nullptr},
               {"orientation", nullptr},
               {"sigma_m", finite_or_null(handled->sigma)},
               {"lost_in_s", or_null(handled->lost_in)}};
  if (handled->position) json["position"] = vector_json(*handled->position);
  if (handled->orientation) json["orientation"] = vector_json(handled->orientation->coeffs());
  return json;
}

/// How often each value of an enumeration came, by its name; null if none did.
template <typename Enum, std::size_t count>
Json counts_json(const std::array<std::size_t, count>& counts) {
  Json json = Json::object();
  std::size_t all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    json[std::string(to_string(static_cast<Enum>(i)))] = counts[i];
    all += counts[i];
  }
  return all == 0 ? Json(nullptr) : json;
}

Json target_summary_json(const TargetStatistics& target) {
  return {{"name", target.name},
          {"verdicts", counts_json<Verdict>(target.verdicts)},
          {"handled", counts_json<Source>(target.handled)},
          {"estimates", counts_json<Outcome>(target.outcomes)},
          {"first_unknown", target.frames(Verdict::unknown) > 0
                                ? Json{{"index", target.first_unknown}, {"reason", target.reason}}
                                : Json(nullptr)}};
}

std::string_view name_of(Geometry geometry) {
  return geometry == Geometry::collision ? "collision" : "visual";
}

/// One name where all links have the same.
Json geometry_json(const RobotOptions& robot) {
  const Geometry geometry = robot.geometry.value_or(Geometry::collision);
  if (robot.geometry_of_links.empty()) return name_of(geometry);
  Json links = Json::object();
  for (const auto& [pattern, of_links] : robot.geometry_of_links)
    links[pattern] = name_of(of_links);
  return {{"default", name_of(geometry)}, {"links", std::move(links)}};
}

Json bag_json(const UsedBag& bag) {
  Json topics = Json::array();
  for (const UsedBag::Topic& topic : bag.topics)
    topics.push_back(
        {{"role", topic.role}, {"name", topic.name}, {"type", topic.type}, {"why", topic.why}});
  return {
      {"topics", std::move(topics)},
      {"poses", bag.poses},
      {"camera", {{"frame", bag.camera_frame}, {"link", bag.camera_link}, {"by", bag.camera_by}}},
      {"time_offset_s", bag.time_offset},
      {"first_publisher", bag.first_publisher},
      {"joint_names", bag.joint_names.empty() ? Json() : Json(bag.joint_names)},
      {"depth_scale", bag.depth_scale ? Json(*bag.depth_scale) : Json()},
      {"depth_along", bag.depth_along_ray ? "ray" : "z"}};
}

Json settings_json(const UsedSettings& used) {
  const DepthRange& range = used.rule.range;
  const auto finite = [](double metres) { return std::isfinite(metres) ? Json(metres) : Json(); };
  Json margins = Json::object(), extras = Json::array();
  for (const auto& [pattern, margin] : used.robot.margins) margins[pattern] = margin;
  for (const ExtraMesh& extra : used.robot.extra)
    extras.push_back({{"link", extra.link}, {"mesh", extra.mesh.string()}});
  Json json = used.clouds ? rule_json(used.clouds->rule) : rule_json(used.rule);
  json.update({{"labels", used.paper_labels ? "paper" : "full"},
               {"beyond", used.beyond == BeyondMeans::visible ? "visible" : "occluded"},
               {"targets", or_null(used.targets)},
               {"target_history_s", used.target_history},
               {"bag", used.bag ? bag_json(*used.bag) : Json(nullptr)},
               {"range", {finite(range.near), finite(range.far)}},
               {"image", used.image == ImageSpace::raw ? "raw" : "rectified"},
               {"geometry", geometry_json(used.robot)},
               {"geometry_fallback", used.robot.geometry_fallback || !used.robot.geometry},
               {"margins", std::move(margins)},
               {"extra", std::move(extras)},
               {"ignore_links", list(used.robot.ignore_links)},
               {"joints", used.robot.joints},
               {"only_links", list(used.robot.only_links)}});
  if (!used.clouds) return json;
  for (const char* of_images : {"labels", "beyond", "range", "image"}) json.erase(of_images);
  json.update({{"merged", used.clouds->merged}, {"times", used.clouds->times}});
  return json;
}

Json pixels_json(const PixelCounts& pixels) {
  return {{"robot", or_null(pixels.robot)}, {"front", pixels.front},
          {"occluded", pixels.occluded},    {"unknown", pixels.unknown},
          {"beyond", pixels.beyond},        {"fringe", pixels.fringe},
          {"uncovered", pixels.uncovered}};
}

/// Returns "pixels", or, of a scan, "points".
std::pair<const char*, Json> counts_of(const PixelCounts& pixels, std::size_t parts) {
  if (parts == 0) return {"pixels", pixels_json(pixels)};
  return {"points", points_json(pixels)};
}

Json frame_json(const FrameReport& report) {
  Json timing;
  for (const Stage& stage : stages) timing[stage.name] = or_null(report.timing.*stage.time);
  const Json age =
      report.joint_age ? Json(static_cast<double>(*report.joint_age) / ns_per_ms) : Json(nullptr);
  Json targets = Json::array(), attached = Json::object();
  for (const TargetReport& target : report.targets) targets.push_back(target_json(target));
  for (const std::size_t body : report.attached) attached[report.links[body]] = body + 1;
  const auto [counts, numbers] = counts_of(report.pixels, report.parts);
  Json json{{"index", report.index},
            {"stamp_ns", or_null(report.stamp)},
            {"joint_age_ms", age},
            {"status", to_string(report.status)},
            {"message", report.message.empty() ? Json(nullptr) : Json(report.message)},
            {counts, numbers},
            {"timing_ms", std::move(timing)},
            {"attached", std::move(attached)},
            {"targets", std::move(targets)}};
  if (report.parts > 0) json["parts"] = report.parts;
  return json;
}

Json faults_json(const Statistics& statistics) {
  Json faults = Json::array();
  for (const Fault& fault : statistics.faults()) {
    Json reasons = Json::array();
    for (const Reason& reason : fault.reasons)
      reasons.push_back(
          {{"message", reason.message}, {"frames", reason.frames}, {"first_index", reason.first}});
    faults.push_back({{"status", to_string(fault.status)},
                      {"frames", fault.frames},
                      {"reasons", std::move(reasons)},
                      {"frames_of_other_reasons", fault.other_reasons}});
  }
  return faults;
}

Json diagnosis_json(const Diagnosis& diagnosis) {
  if (diagnosis.cause == Diagnosis::Cause::none) return nullptr;
  return {{"cause", to_string(diagnosis.cause)},
          {"other", diagnosis.other == Diagnosis::Cause::none ? Json(nullptr)
                                                              : Json(to_string(diagnosis.other))},
          {"message", diagnosis.message},
          {"frame", diagnosis.frame},
          {"agreement", diagnosis.score},
          {"agreement_after", diagnosis.best}};
}

Json summary_json(const Statistics& statistics, std::span<const std::string> missing_links,
                  std::span<const std::string> notes) {
  Json timing;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const auto q = statistics.timing(i);
    timing[stages[i].name] =
        q ? Json{{"median", q->median}, {"p99", q->p99}, {"max", q->max}} : Json(nullptr);
  }
  Json targets = Json::array();
  for (const TargetStatistics& target : statistics.targets())
    targets.push_back(target_summary_json(target));
  const auto [counts, numbers] = counts_of(statistics.pixels(), statistics.parts());
  Json json{{"frames", statistics.frames()},
            {"bad_frames", statistics.bad_frames()},
            {"shows_robot", statistics.usable_frames() > 0 && statistics.shows_robot()},
            {"timing_ms", std::move(timing)},
            {counts, numbers},
            {"faults", faults_json(statistics)},
            {"targets", std::move(targets)},
            {"missing_links", list(missing_links)},
            {"calibration", drift_json(statistics.drift())},
            {"diagnosis", diagnosis_json(statistics.diagnosis())},
            {"compared_poses", statistics.diagnosis().poses},
            {"notes", list(notes)}};
  if (statistics.parts() > 0) json["most_parts"] = statistics.parts();
  return json;
}

Json link_json(const LinkReport& link) {
  Json size = nullptr;
  if (!link.bounds.isEmpty())
    size = {link.bounds.sizes().x(), link.bounds.sizes().y(), link.bounds.sizes().z()};
  return {{"name", link.link},
          {"drawn", link.drawn},
          {"missing", link.missing},
          {"reason", link.reason},
          {"sources", link.sources},
          {"triangles", link.triangles},
          {"watertight", link.drawn ? Json(link.watertight) : Json(nullptr)},
          {"margin_m", link.margin},
          {"size_m", std::move(size)},
          {"load_ms", link.load_ms}};
}

Json joint_json(const Robot& robot, const Joint& joint) {
  Json mimic = nullptr;
  if (joint.mimics && joint.variable)
    mimic = {{"variable", robot.variables()[*joint.variable]},
             {"multiplier", joint.multiplier},
             {"offset", joint.offset}};
  return {{"name", joint.name},
          {"type", to_string(joint.type)},
          {"parent", robot.links()[joint.parent]},
          {"child", robot.links()[joint.child]},
          {"lower", or_null(joint.lower)},
          {"upper", or_null(joint.upper)},
          {"mimic", std::move(mimic)}};
}

}  // namespace

Json points_json(const PixelCounts& points) {
  Json json;
  for (const auto& [label, count] : point_counts) json[label] = points.*count;
  return json;
}

Json target_json(const TargetReport& target) {
  const Judgement none;
  const Judgement& judged = target.judgement ? *target.judgement : none;
  const auto of_judged = [&](auto value) { return target.judgement ? Json(value) : Json(nullptr); };
  const auto share = [&](double value) { return judged.inside > 0 ? Json(value) : Json(nullptr); };
  return {{"name", target.name},
          {"covered", of_judged(judged.covered)},
          {"inside", of_judged(judged.inside)},
          {"occluded_fraction", share(judged.occluded)},
          {"front_fraction", share(judged.front)},
          {"clear_fraction", share(judged.clear)},
          {"unknown_fraction", share(judged.unknown)},
          {"hidden_by_other_fraction",
           judged.hidden_by_other ? share(*judged.hidden_by_other) : Json(nullptr)},
          {"measured_fraction", judged.measured ? share(*judged.measured) : Json(nullptr)},
          {"seen_past_fraction", judged.seen_past ? share(*judged.seen_past) : Json(nullptr)},
          {"verdict", to_string(target.verdict)},
          {"blame", target.judgement ? blame_json(judged) : Json(nullptr)},
          {"point", target.point ? vector_json(*target.point) : Json(nullptr)},
          {"point_pixels", target.point ? Json(judged.point_pixels) : Json(nullptr)},
          {"point_spread_m", target.point ? Json(judged.point_spread) : Json(nullptr)},
          {"handled", handled_json(target.handled)},
          {"forecast", target.forecast.empty() ? Json(nullptr) : intervals_json(target.forecast)},
          {"estimate", target.estimate ? Json(to_string(*target.estimate)) : Json(nullptr)},
          {"stamp_ns", or_null(target.stamp)},
          {"reason", or_null(target.reason)}};
}

Json drift_json(const Drift& drift) {
  if (!drift.is_known) return nullptr;
  constexpr double degrees = 180.0 / std::numbers::pi;
  const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3; };
  return {{"moved_mm", rounded(1e3 * drift.position())},
          {"moved_error_mm", rounded(1e3 * drift.position_error())},
          {"turned_degrees", rounded(degrees * drift.rotation())},
          {"turned_error_degrees", rounded(degrees * drift.rotation_error())},
          {"time_offset_ms", rounded(1e3 * drift.time_offset.value)},
          {"time_offset_error_ms", rounded(2e3 * drift.time_offset.sigma)},
          {"has_moved", drift.has_moved},
          {"clocks_differ", drift.clocks_differ},
          {"camera_or_clocks", drift.camera_or_clocks},
          {"bumped_at", or_null(drift.bumped_at)},
          {"bumped_within", drift.bumped_at ? Json(drift.bumped_within) : Json(nullptr)}};
}

Json renderer_json(const RendererInfo& info) {
  return {{"backend", to_string(info.backend)},
          {"isa", or_null(info.isa)},
          {"threads", info.backend == Backend::gl ? Json(nullptr) : Json(info.threads)},
          {"device", or_null(info.device)}};
}

std::string report_start(const ReportHead& head) {
  return std::string(report_json_start) + dump(PENUMBRA_VERSION) +
         ",\n\"input\": " + dump(head.input) +
         ",\n\"renderer\": " + dump(head.renderer ? renderer_json(*head.renderer) : Json(nullptr)) +
         ",\n\"settings\": " + dump(settings_json(head.settings)) +
         ",\n\"links\": " + dump(list(head.links)) + ",\n\"frames\": [";
}

std::string report_frame(const FrameReport& report) { return dump(frame_json(report)); }

std::string report_end(const Statistics& statistics, std::span<const std::string> missing_links,
                       std::span<const std::string> notes) {
  return "\n],\n\"summary\": " + dump(summary_json(statistics, missing_links, notes)) + "}\n";
}

std::string unfinished_report_end() { return "\n],\n\"summary\": null}\n"; }

ReportWriter::ReportWriter(const std::filesystem::path& file, std::string start)
    : output_(file), waiting_(std::move(start)) {}

void ReportWriter::add(std::string_view frame) {
  waiting_ += is_first_ ? "\n" : ",\n";
  waiting_ += frame;
  is_first_ = false;
  if (waiting_.size() < write_size) return;
  output_.write(waiting_.data(), waiting_.size());
  waiting_.clear();
}

void ReportWriter::finish(std::string_view end) {
  waiting_ += end;
  output_.write(waiting_.data(), waiting_.size());
  output_.close();
}

std::string robot_json(const Robot& robot) {
  Json links = Json::array();
  for (const LinkReport& link : robot.report()) links.push_back(link_json(link));
  Json joints = Json::array();
  for (const Joint& joint : robot.joints()) joints.push_back(joint_json(robot, joint));
  return dump(Json{{"robot", robot.name()},
                   {"links", std::move(links)},
                   {"joints", std::move(joints)},
                   {"variables", list(robot.variables())},
                   {"notes", list(robot.notes())}},
              2);
}

}  // namespace penumbra::io
