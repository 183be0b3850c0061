// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra {

/// The rule that fits a sensor.
struct CloudTuning {
  std::size_t scans = 0;
  std::size_t points = 0;  ///< that lie on the robot, of all scans
  /// Of r - s (CloudRule) of these points, metres: the median, and half of what the middle 68 % of
  /// them span, which is the standard deviation of normal noise.
  double bias = 0.0, deviation = 0.0;
  /// With tolerance |bias| + 3.5 deviations, and a beam that holds the rings around the robot's
  /// outline whose points are more often of its range than those farther out, and one ring more.
  /// What could not be measured is as it was.
  CloudRule rule;
  bool has_tolerance = false, has_beam = false;  ///< measured
  std::vector<std::string> problems;             ///< why something is not measured, a line each
};

/// Measures tolerance and beam in scans of a robot that stands or moves free. It needs no truth:
/// each scan is labelled by many rules, and the counts of labels say how ranges are distributed.
class CloudTuner {
 public:
  /// `rule`: what is not measured.
  explicit CloudTuner(const CloudRule& rule) : rule_(rule) {}

  /// Adds a scan; takes as long as labelling it 35 times. Returns false for a scan without rays, or
  /// whose poses are not all known. Leaves the pipeline with `rule`.
  bool add(Pipeline& pipeline, const Frame& frame);

  [[nodiscard]] CloudTuning result() const;

 private:
  static constexpr std::size_t steps = 21;  // of tolerances
  static constexpr std::array beams = {0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.010};
  [[nodiscard]] static double tolerance_at(std::size_t step);
  void measure_ranges(CloudTuning& out) const;
  void measure_beam(CloudTuning& out) const;

  CloudRule rule_;
  std::size_t scans_ = 0, on_robot_ = 0;
  std::string refused_because_;                        // of the first scan that was not added
  std::array<std::size_t, steps> front_{}, beyond_{};  // by tolerance
  std::array<std::size_t, beams.size()> mixed_{}, behind_{};  // in reach of a beam: within `mixing`
};

}  // namespace penumbra
