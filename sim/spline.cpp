// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include <sim/spline.hpp>

namespace penumbra::sim {

Spline::Spline(std::vector<Knot> knots) : knots_(std::move(knots)) {
  assert(knots_.size() >= 2);
  const std::size_t n = knots_.size();
  const Eigen::Index size = knots_.front().value.size();
  slopes_.assign(n, Eigen::VectorXd::Zero(size));
  // Accelerations agree at inner knots: h1 s0 + 2 (h0 + h1) s1 + h0 s2 = 3 (h1 d0 + h0 d1) with
  // the chords' slopes d; solved by elimination from the first inner knot to the last.
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = knots_[i].time - knots_[i - 1].time;
    const double h1 = knots_[i + 1].time - knots_[i].time;
    const Eigen::VectorXd d0 = (knots_[i].value - knots_[i - 1].value) / h0;
    const Eigen::VectorXd d1 = (knots_[i + 1].value - knots_[i].value) / h1;
    const double pivot = 2.0 * (h0 + h1) - h1 * upper[i - 1];
    upper[i] = h0 / pivot;
    slopes_[i] = (3.0 * (h1 * d0 + h0 * d1) - h1 * slopes_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) slopes_[i] -= upper[i] * slopes_[i + 1];
}

Eigen::VectorXd Spline::at(double time) const {
  if (time <= knots_.front().time) return knots_.front().value;
  if (time >= knots_.back().time) return knots_.back().value;
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), time,
                                     [](double t, const Knot& knot) { return t < knot.time; });
  const auto i = static_cast<std::size_t>(next - knots_.begin()) - 1;
  const Knot &a = knots_[i], &b = knots_[i + 1];
  const double h = b.time - a.time, s = (time - a.time) / h;
  const double r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * a.value + s * s * (1.0 + 2.0 * r) * b.value +
         h * s * r * (r * slopes_[i] - s * slopes_[i + 1]);
}

}  // namespace penumbra::sim
