// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace penumbra::sim {

/// A value at a time in seconds.
struct Knot {
  double time = 0.0;
  Eigen::VectorXd value;
};

/// A smooth path through knots: the cubic spline with continuous acceleration and zero velocity at
/// both ends.
class Spline {
 public:
  /// `knots`: at least two, with strictly increasing times and values of one size.
  explicit Spline(std::vector<Knot> knots);

  /// Returns the value at a time. Before the first and after the last knot it is that knot's value.
  [[nodiscard]] Eigen::VectorXd at(double time) const;

 private:
  std::vector<Knot> knots_;
  std::vector<Eigen::VectorXd> slopes_;  // per second, at the knots
};

}  // namespace penumbra::sim
