// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra {

std::string_view to_string(Source source) {
  constexpr std::array<std::string_view, 4> names = {"measured", "predicted", "held", "lost"};
  return names[static_cast<std::size_t>(source)];
}

std::string_view to_string(Motion motion) {
  constexpr std::array<std::string_view, 4> names = {"constant_twist", "constant_velocity",
                                                     "along_direction", "still"};
  return names[static_cast<std::size_t>(motion)];
}

std::string_view to_string(PointMotion motion) {
  return motion == PointMotion::hold ? "hold" : "constant_velocity";
}

std::string_view to_string(Outcome outcome) {
  constexpr std::array<std::string_view, 5> names = {"accepted", "refused_verdict", "refused_gate",
                                                     "refused_late", "refused_invalid"};
  return names[static_cast<std::size_t>(outcome)];
}

}  // namespace penumbra
