// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace penumbra::detail {

/// Coefficients of a polynomial, the constant one first.
using Polynomial = std::vector<double>;

[[nodiscard]] Polynomial add(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial multiply(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial derivative(const Polynomial& a);

/// The largest X such that the polynomial is positive on 0 <= x < X; infinity where it is positive
/// for every x >= 0. A root where it only touches zero counts.
[[nodiscard]] double positive_until(const Polynomial& a);

}  // namespace penumbra::detail
