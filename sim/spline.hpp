// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace penumbra::sim {

/// A value at a time, seconds.
struct Knot {
  double time = 0.0;
  Eigen::VectorXd value;
};

/// A smooth path through knots: the cubic spline with continuous acceleration that stands still at
/// both ends.
class Spline {
 public:
  /// Knots in the order of strictly rising times, at least two, with values of one size.
  explicit Spline(std::vector<Knot> knots);

  /// Before the first and after the last knot: that knot's value.
  [[nodiscard]] Eigen::VectorXd at(double time) const;

 private:
  std::vector<Knot> knots_;
  std::vector<Eigen::VectorXd> slopes_;  // per second, at the knots
};

}  // namespace penumbra::sim
