// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <penumbra/base/setting.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra::io {

using Json = nlohmann::ordered_json;  // keeps the order of keys

inline Json or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Returns one line. Replaces bytes that are not UTF-8, which names from files may hold.
inline std::string json_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns [x, y, z, qx, qy, qz, qw].
inline Json pose_json(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const auto& t = pose.translation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

/// Returns the settings of a LabelRule or CloudRule by their names.
template <typename Rule>
Json rule_json(const Rule& rule) {
  Json json;
  for_each_setting<Rule>([&](const auto& setting) {
    const auto& value = rule.*setting.member;
    if constexpr (requires { value.a; })
      json[setting.name] = {value.a, value.b, value.c};
    else
      json[setting.name] = value;
  });
  return json;
}

/// Returns "renderer" of report.json.
[[nodiscard]] Json renderer_json(const RendererInfo& info);

/// Returns "calibration" of reports and summaries; null while nothing is known.
[[nodiscard]] Json drift_json(const Drift& drift);

/// Returns a scan's numbers of points by the names of their labels.
[[nodiscard]] Json points_json(const PixelCounts& points);

/// Returns one of "targets" of report.json.
[[nodiscard]] Json target_json(const TargetReport& target);

/// Returns what a motion will do to a target, in seconds from its begin.
[[nodiscard]] Json intervals_json(std::span<const VerdictInterval> intervals);

}  // namespace penumbra::io
