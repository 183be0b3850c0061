// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <penumbra/planning/view_planning.hpp>

namespace penumbra::io {

/// The result of `penumbra view-planning`. Refers to its parts.
struct ViewPlan {
  std::string input;     ///< as the user named it
  std::size_t seen = 0;  ///< frames of the input
  std::span<const CameraCandidate> candidates;
  std::span<const Frame> motion;
  const CandidateViews& views;
  std::span<const CameraSet> best;  ///< by size

  [[nodiscard]] std::string target(std::size_t i) const {
    return std::string(motion.front().targets[i].name);
  }
  /// Returns the names of a set's cameras: "left + right".
  [[nodiscard]] std::string names(const CameraSet& set) const;
};

/// Returns the content of view_planning.json.
[[nodiscard]] std::string view_planning_json(const ViewPlan& plan);

}  // namespace penumbra::io
