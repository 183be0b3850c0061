// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

/// How the options apply to a link.
struct LinkChoice {
  bool draw = false;
  Geometry geometry = Geometry::collision;
  double margin = 0.0;
  bool lacks_geometry = false;  ///< not drawn: it has only the other kind than was asked for
  bool is_substitute = false;   ///< drawn by visual geometry; no kind was asked for
  std::string reason;           ///< why it is not drawn, or which geometry was chosen
};

/// Returns one choice for each of Urdf::links. Throws InputError for a pattern that matches no
/// link, for two patterns with different values for one link (a plain name overrides patterns), for
/// a margin beyond 1 m, and, unless missing meshes are allowed, for links that have only the other
/// kind than was asked for: what is behind them would look visible.
[[nodiscard]] std::vector<LinkChoice> choose_links(const Urdf& urdf, const RobotOptions& options);

/// Lists the links that lack the geometry that was asked for, and those that are drawn by visual
/// geometry because they have no other, with the remedies: one line for each kind.
[[nodiscard]] std::vector<std::string> geometry_notes(const Urdf& urdf,
                                                      const std::vector<LinkChoice>& choices);

}  // namespace penumbra::detail
