// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <sim/experiments/confidence.hpp>

namespace penumbra::sim {
namespace {

constexpr double tail = 0.025;

/// Probability of at most `count` events where `mean` are expected.
double poisson_up_to(std::size_t count, double mean) {
  double sum = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    const auto k = static_cast<double>(i);
    sum += std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
  }
  return sum;
}

/// Probability that at most `count` of `all` come out, each with probability p in 0..1, not either.
double binomial_up_to(std::size_t count, std::size_t all, double p) {
  const auto n = static_cast<double>(all);
  double sum = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    const auto k = static_cast<double>(i);
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                    k * std::log(p) + (n - k) * std::log1p(-p));
  }
  return sum;
}

/// Where a falling function is `value`, between two ends.
template <typename Function>
double crossing(const Function& falling, double value, double low, double high) {
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (falling(middle) > value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Confidence count_confidence(std::size_t count) {
  const auto k = static_cast<double>(count);
  const double most = k + 10 * std::sqrt(k + 1) + 10;
  const auto up_to = [](std::size_t c) {
    return [c](double mean) { return poisson_up_to(c, mean); };
  };
  return {count == 0 ? 0.0 : crossing(up_to(count - 1), 1 - tail, 0, most),
          crossing(up_to(count), tail, 0, most)};
}

Confidence share_confidence(std::size_t count, std::size_t all) {
  const auto up_to = [all](std::size_t c) {
    return [c, all](double p) { return binomial_up_to(c, all, p); };
  };
  return {count == 0 ? 0.0 : crossing(up_to(count - 1), 1 - tail, 0, 1),
          count == all ? 1.0 : crossing(up_to(count), tail, 0, 1)};
}

}  // namespace penumbra::sim
