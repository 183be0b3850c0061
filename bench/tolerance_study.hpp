// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../tests/support/pasted_object.hpp"
#include "../tests/support/real_frames.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <penumbra/labels/labels.hpp>

namespace penumbra::study {

struct NamedRule {
  std::string name;
  LabelRule rule;
};

struct NamedKind {
  std::string name;
  test::ObjectKind kind;
};

/// Percent of the robot mask, one value per frame.
struct Untouched {
  std::vector<double> front, beyond, unknown;
};

/// Percent of an object's measured pixels that are labelled front.
struct Seen {
  double core = 0.0;  ///< but for the band
  double band = 0.0;  ///< of 2 pixels at its edge
};

/// What each rule says of the frames as they are: nothing stands before the robot.
[[nodiscard]] std::vector<Untouched> study_untouched(const std::vector<test::RealFrame>& frames,
                                                     const std::vector<NamedRule>& rules);

/// What each rule says of objects pasted at `gap`, `placements` in each frame.
[[nodiscard]] std::vector<Seen> study_objects(std::vector<test::RealFrame>& frames,
                                              const std::vector<NamedRule>& rules,
                                              const test::ObjectKind& kind, double gap,
                                              int placements, std::uint64_t seed);

[[nodiscard]] double mean(const std::vector<double>& values);
[[nodiscard]] double largest(const std::vector<double>& values);

/// One line of a plot.
struct Curve {
  std::string name;
  std::vector<double> x, y;
};

/// An SVG line chart of percentages over centimetres.
[[nodiscard]] std::string svg_plot(const std::string& title, const std::vector<Curve>& curves);

}  // namespace penumbra::study
