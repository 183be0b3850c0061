// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/cloud/cloud_pipeline.hpp>

namespace penumbra::io {

/// Of points, in the order of Label.
inline constexpr std::array<std::string_view, label_count> point_label_names = {
    "clear", "front", "occluded", "unknown", "beyond", "fringe"};

/// What became of the clouds of one topic, or of a recording.
struct CloudSummary {
  std::string name = {};
  std::size_t clouds = 0;
  std::map<FrameStatus, std::size_t> statuses = {};
  std::map<FrameStatus, std::string> messages = {};  ///< the first of each
  std::array<std::size_t, label_count> points{};     ///< by label, of all clouds
  std::string time_note = {};                        ///< CloudPoints::time_note of the first
  std::string body_note = {}, target_note = {};      ///< the first of each in the reports
  std::size_t not_handled = 0;                       ///< clouds with TargetReport::wants_stamp
  std::size_t parts = 0;                             ///< the most of a scan
  double milliseconds = 0;                           ///< all labelling

  /// `fault`: in place of the report's message, if not empty. `elapsed`: milliseconds.
  void add(const CloudReport& report, const std::string& fault, double elapsed);
  [[nodiscard]] std::size_t labelled() const;  ///< clouds whose points are not all unknown
  /// Returns a line for each thing that looks wrong in labelled clouds.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Returns a line with the name for each status of clouds that is not ok, and for each warning.
  [[nodiscard]] std::vector<std::string> notes() const;
};

}  // namespace penumbra::io
