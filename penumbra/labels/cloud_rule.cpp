// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {

CloudRule CloudRule::for_sensor(std::string_view name) {
  struct Sensor {
    std::string_view name;
    double tolerance, beam;  // about three standard deviations; half of the beam's divergence
  };
  static constexpr Sensor sensors[] = {{"lidar_2cm", 0.03, 0.003},
                                       {"livox_mid360", 0.06, 0.003},
                                       {"ouster_os1", 0.04, 0.003},
                                       {"hokuyo", 0.05, 0.004}};
  for (const Sensor& sensor : sensors)
    if (sensor.name == name)
      return {.tolerance = {sensor.tolerance, 0.0, 0.0}, .beam = sensor.beam};
  throw InputError("sensor '" + std::string(name) +
                   "': expected lidar_2cm, livox_mid360, ouster_os1 or hokuyo");
}

void CloudRule::check() const {
  check_settings(*this);
  if (!tolerance.is_valid())
    throw InputError("tolerance " + std::to_string(tolerance.a) + "," +
                     std::to_string(tolerance.b) + "," + std::to_string(tolerance.c) +
                     ": a + b s + c s^2 must not be negative at any range, and each number be "
                     "below 1; is a in metres?");
}

}  // namespace penumbra
