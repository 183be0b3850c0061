// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <penumbra/pipeline/frame.hpp>

#include <io/json-inl.hpp>
#include <io/web/live_frame.hpp>

namespace penumbra::io {
namespace {

constexpr double milliseconds = 1e-6;  // per nanosecond
constexpr std::array statuses_without_pose{
    FrameStatus::missing_joints, FrameStatus::stale_joints, FrameStatus::missing_transform,
    FrameStatus::stale_transform, FrameStatus::poses_disagree};

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Vector>
Json vector_or_null(const Vector& vector) {
  if (!vector.allFinite()) return nullptr;
  Json json = Json::array();
  for (const double value : vector) json.push_back(value);
  return json;
}

std::string_view verdict_of(std::uint8_t value) {
  constexpr std::array names{"unknown", "visible", "partial", "hidden", "out_of_view"};
  return names[value < names.size() ? value : 0];
}

Json source_of(std::uint8_t value) {
  constexpr std::array names{"", "measured", "predicted", "held", "lost"};
  return value > 0 && value < names.size() ? Json(names[value]) : Json(nullptr);
}

Json estimate_of(std::uint8_t value) {
  constexpr std::array names{
      "", "accepted", "refused_verdict", "refused_gate", "refused_late", "refused_invalid"};
  return value > 0 && value < names.size() ? Json(names[value]) : Json(nullptr);
}

Json handled_json(const TargetMessage& target) {
  const Json source = source_of(target.source);
  if (source.is_null()) return nullptr;
  return {{"source", source},
          {"age_s", number_or_null(target.age)},
          {"position", vector_or_null(target.pose.position)},
          {"orientation", vector_or_null(target.pose.orientation)},
          {"sigma_m", number_or_null(target.sigma)}};
}

Json blame_json(const TargetMessage& target) {
  Json blame = Json::array();
  for (const BlameMessage& one : target.blame)
    blame.push_back({{"link", one.link}, {"fraction", number_or_null(one.fraction)}});
  return blame;
}

Json target_json(const TargetMessage& target) {
  const auto of_judged = [&](auto value) { return target.judged ? Json(value) : Json(nullptr); };
  const Json point = vector_or_null(target.point);
  const auto of_point = [&](const Json& value) { return point.is_null() ? Json(nullptr) : value; };
  return {{"name", target.name},
          {"covered", of_judged(target.covered)},
          {"inside", of_judged(target.inside)},
          {"occluded_fraction", number_or_null(target.occluded_fraction)},
          {"front_fraction", number_or_null(target.front_fraction)},
          {"clear_fraction", number_or_null(target.clear_fraction)},
          {"unknown_fraction", number_or_null(target.unknown_fraction)},
          {"hidden_by_other_fraction", number_or_null(target.hidden_by_other_fraction)},
          {"measured_fraction", number_or_null(target.measured_fraction)},
          {"seen_past_fraction", number_or_null(target.seen_past_fraction)},
          {"verdict", verdict_of(target.verdict)},
          {"blame", of_judged(blame_json(target))},
          {"point", point},
          {"point_pixels", of_point(target.point_pixels)},
          {"point_spread_m", of_point(number_or_null(target.point_spread))},
          {"handled", handled_json(target)},
          {"estimate", estimate_of(target.estimate)},
          {"stamp_ns", target.has_stamp ? Json(target.stamp) : Json(nullptr)},
          {"reason", or_null(target.reason)}};
}

/// Uncovered pixels are published as unknown ones: how many they are is not known here. Nothing is
/// of a label image that could not be read.
Json pixels_json(const std::string& labels, bool has_pose) {
  if (labels.empty())
    return {{"robot", nullptr},  {"front", nullptr},  {"occluded", nullptr}, {"unknown", nullptr},
            {"beyond", nullptr}, {"fringe", nullptr}, {"uncovered", nullptr}};
  std::array<std::size_t, label_count> counts{};
  for (const char label : labels) {
    const auto value = static_cast<unsigned char>(label);
    ++counts[value < counts.size() ? value : 3U];
  }
  const std::size_t robot = counts[1] + counts[2] + counts[3] + counts[4];
  return {{"robot", has_pose ? Json(robot) : Json(nullptr)},
          {"front", counts[1]},
          {"occluded", counts[2]},
          {"unknown", counts[3]},
          {"beyond", counts[4]},
          {"fringe", counts[5]},
          {"uncovered", nullptr}};
}

}  // namespace

bool has_live_pose(const std::string& status) {
  for (const FrameStatus without : statuses_without_pose)
    if (status == to_string(without)) return false;
  return true;
}

std::string live_report(const TargetsMessage& message, std::uint64_t number,
                        std::optional<std::int64_t> joint_age, const std::string& labels) {
  Json targets = Json::array();
  for (const TargetMessage& target : message.targets) targets.push_back(target_json(target));
  const Json age = joint_age ? Json(static_cast<double>(*joint_age) * milliseconds) : Json(nullptr);
  const Json json{{"index", number},
                  {"stamp_ns", message.header.stamp},
                  {"joint_age_ms", age},
                  {"status", message.status},
                  {"message", or_null(message.message)},
                  {"pixels", pixels_json(labels, has_live_pose(message.status))},
                  {"timing_ms", nullptr},
                  {"targets", std::move(targets)}};
  return json_text(json);
}

}  // namespace penumbra::io
