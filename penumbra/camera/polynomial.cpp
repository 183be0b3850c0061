// SPDX-License-Identifier: Apache-2.0
// First positive root of a polynomial, found without missing one: x = t / (1 - t) takes [0, inf) to
// [0, 1), and sum a_i x^i (1 - t)^n = sum a_i t^i (1 - t)^(n - i) is a Bernstein form with the
// coefficients a_i / binomial(n, i). A form whose coefficients are >= 0 and whose first one is > 0
// is positive on its whole interval but for the right end; other intervals are halved by de
// Casteljau's scheme (Farouki, The Bernstein polynomial basis: a centennial retrospective, 2012).
#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include <penumbra/camera/polynomial-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr int max_depth = 50;  // halvings of [0, 1]: 2^-50, near the precision of a double

bool surely_positive(const Polynomial& bernstein) {
  return bernstein.front() > 0 &&
         std::all_of(bernstein.begin() + 1, bernstein.end(), [](double b) { return b >= 0; });
}

/// Splits the form at the middle of its interval: `form` becomes the left half; returns the right.
Polynomial split(Polynomial& form) {
  Polynomial right(form.size());
  Polynomial level = form;
  for (std::size_t i = 0; i < form.size(); ++i) {
    form[i] = level.front();
    right[form.size() - 1 - i] = level.back();
    for (std::size_t j = 0; j + 1 < level.size(); ++j) level[j] = 0.5 * (level[j] + level[j + 1]);
    level.pop_back();
  }
  return right;
}

/// Left end of the first interval of the finest width in which the form may not be positive.
std::optional<double> first_root(Polynomial form, double begin, double width, int depth) {
  if (surely_positive(form)) return std::nullopt;
  if (form.front() <= 0 || depth == max_depth) return begin;
  const Polynomial right = split(form);
  width *= 0.5;
  if (const auto root = first_root(std::move(form), begin, width, depth + 1)) return root;
  return first_root(right, begin + width, width, depth + 1);
}

}  // namespace

Polynomial add(const Polynomial& a, const Polynomial& b) {
  Polynomial sum(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] += b[i];
  return sum;
}

Polynomial multiply(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return product;
}

Polynomial derivative(const Polynomial& a) {
  if (a.size() < 2) return {0.0};
  Polynomial result(a.size() - 1);
  for (std::size_t i = 1; i < a.size(); ++i) result[i - 1] = static_cast<double>(i) * a[i];
  return result;
}

double positive_until(const Polynomial& a) {
  Polynomial form = a;
  while (form.size() > 1 && form.back() == 0) form.pop_back();
  double binomial = 1;
  const std::size_t n = form.size() - 1;
  for (std::size_t i = 0; i <= n; ++i) {
    form[i] /= binomial;
    binomial *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  }
  const auto t = first_root(std::move(form), 0.0, 1.0, 0);
  return t ? *t / (1 - *t) : std::numeric_limits<double>::infinity();
}

}  // namespace penumbra::detail
