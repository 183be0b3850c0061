// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

/// What the options make of a link.
struct LinkChoice {
  bool draw = false;
  Geometry geometry = Geometry::collision;
  double margin = 0.0;
  bool lacks_geometry = false;  ///< not drawn: it has geometry, but none of the kind `geometry`
  std::string reason;           ///< why it is not drawn, or what was chosen
};

/// One choice for each of Urdf::links. Throws InputError for a pattern that matches no link, for
/// two patterns that say different things of one link (a plain name goes before patterns), for a
/// margin that is no sensible number, and, unless missing meshes are allowed, for links that have
/// geometry, but none of the chosen kind: what stands behind them would look visible.
[[nodiscard]] std::vector<LinkChoice> choose_links(const Urdf& urdf, const RobotOptions& options);

/// Which links lack the chosen geometry but have the other, and the ways out, a line for each kind.
[[nodiscard]] std::vector<std::string> lacking_notes(const Urdf& urdf,
                                                     const std::vector<LinkChoice>& choices);

[[nodiscard]] std::string to_string(Geometry geometry);

}  // namespace penumbra::detail
