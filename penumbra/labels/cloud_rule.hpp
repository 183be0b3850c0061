// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include <penumbra/base/setting.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {

/// The rule of labelling points. r is a point's distance from the sensor's origin, s that of the
/// robot's first surface on the point's ray.
///
/// 1. A point whose ray meets the robot is front if r < s - e(s), beyond if r > s + k e(s), else
///    occluded.
/// 2. A point whose ray misses the robot is clear.
/// 3. A beam is as wide as `beam` to all sides, and may return a mixture of what it meets. Clear
///    and front points become fringe if a ray at most `beam` from theirs (or up to 0.14 degrees
///    more) meets the robot at s, and s - e(s) <= r <= s + mixing.
struct CloudRule {
  Tolerance tolerance{.a = 0.03, .b = 0.0, .c = 0.0};  ///< e(s)
  double beyond_factor = 2.0;                          ///< k
  double beam = 0.003;                                 ///< radians
  double mixing = 0.5;                                 ///< metres

  static constexpr double max_beam = 0.01, max_mixing = 100.0;

  static constexpr auto settings() {
    return std::tuple(
        Setting("tolerance", &CloudRule::tolerance, {}, "m, m/m, m/m^2",
                "A, B, C, each below 1, of e(s) = A + B s + C s^2 >= 0 metres: a range that "
                "differs by less is "
                "the same"),
        Setting("beyond_factor", &CloudRule::beyond_factor, {1, 100}, "",
                "how many tolerances behind the model beyond starts"),
        Setting("beam", &CloudRule::beam, {0, max_beam}, "rad",
                "how far from a point's ray its return may come: half of the beam, and "
                "errors of the robot's pose"),
        Setting("mixing", &CloudRule::mixing, {0, max_mixing}, "m",
                "how far behind the robot a return may lie that mixes it with what is behind"));
  }

  /// Returns the rule of a sensor: lidar_2cm (the default), livox_mid360, ouster_os1 or hokuyo. All
  /// are estimates from data sheets. Throws InputError for another name.
  [[nodiscard]] static CloudRule for_sensor(std::string_view name);

  /// Throws InputError for settings out of range.
  void check() const;
};

}  // namespace penumbra
