// SPDX-License-Identifier: Apache-2.0
// With z = (x, y), r = |z|, p = (p2, p1) and R the radial factor, the polynomial models are
//   distort(z) = z R(r^2) + 2 (p . z) z + p r^2.
// Its derivative is symmetric: radial eigenvalues f'(r) and f(r) / r with f(r) = r R(r^2), and a
// tangential part between -6 |p| r and 6 |p| r. Where f' and f / r exceed 6 |p| r it is positive
// definite, and so one-to-one on the disc.
// The images of the circles |z| = r are then nested, and z is parallel to w = y - p r^2 for
// y = distort(z). That leaves one unknown: r is where f(r) + 2 r^2 p . w / |w| grows past |w|.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/distortion.hpp>
#include <penumbra/camera/polynomial-inl.hpp>

namespace penumbra {
namespace {

using detail::Polynomial;

constexpr double right_angle = std::numbers::pi / 2;

bool all_zero(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double k) { return k == 0; });
}

std::string_view expected_count(DistortionModel model) {
  switch (model) {
    case DistortionModel::plumb_bob:
      return "5 (k1 k2 p1 p2 k3) or 4";
    case DistortionModel::rational_polynomial:
      return "8 (k1 k2 p1 p2 k3 k4 k5 k6)";
    case DistortionModel::equidistant:
      return "4 (k1 k2 k3 k4)";
    case DistortionModel::none:
      break;
  }
  return "no coefficients, or only 0";
}

bool count_fits(DistortionModel model, std::span<const double> k) {
  switch (model) {
    case DistortionModel::plumb_bob:
      return k.size() == 4 || k.size() == 5;
    case DistortionModel::rational_polynomial:
      return k.size() == 8 || k.size() == 12 || k.size() == 14;
    case DistortionModel::equidistant:
      return k.size() == 4;
    case DistortionModel::none:
      break;
  }
  return all_zero(k);
}

void check_coefficients(DistortionModel model, std::string_view name, std::span<const double> k) {
  std::ostringstream what;
  what << "distortion model \"" << name << "\": ";
  const auto odd = std::find_if(k.begin(), k.end(), [](double c) { return !std::isfinite(c); });
  if (odd != k.end()) {
    what << "coefficient " << odd - k.begin() + 1 << " is " << *odd << ", not a finite number";
  } else if (!count_fits(model, k)) {
    what << "it has " << k.size() << " coefficients and needs " << expected_count(model);
  } else if (model == DistortionModel::rational_polynomial && !all_zero(k.subspan(8))) {
    what << "coefficients 9 to " << k.size()
         << " (thin prism, tilt) are not supported and must be 0";
  } else {
    return;
  }
  throw InputError(what.str());
}

/// The polynomial in x whose coefficients are those of x^2, x^4, ...
Polynomial in_squares(std::span<const double> even) {
  Polynomial result(2 * even.size() - 1, 0.0);
  for (std::size_t i = 0; i < even.size(); ++i) result[2 * i] = even[i];
  return result;
}

template <std::size_t N>
double horner(const std::array<double, N>& a, double x) {
  double sum = 0;
  for (std::size_t i = N; i-- > 0;) sum = sum * x + a[i];
  return sum;
}

template <std::size_t N>
double horner_derivative(const std::array<double, N>& a, double x) {
  double sum = 0;
  for (std::size_t i = N; i-- > 1;) sum = sum * x + static_cast<double>(i) * a[i];
  return sum;
}

/// Up to where n(x) / d(x), the derivative of x n(x) / d(x) and d(x) stay positive, the first two
/// by more than 6 p x.
double monotone_until(const Polynomial& n, const Polynomial& d, double p) {
  using detail::add, detail::derivative, detail::multiply;
  const Polynomial minus_6px{0, -6 * p};
  const Polynomial minus_d = multiply({-1}, d);
  // d^2 times the derivative of x n / d
  const Polynomial slope =
      add(multiply(n, d), multiply({0, 1}, add(multiply(derivative(n), d),
                                               multiply(n, multiply({-1}, derivative(d))))));
  return std::min({detail::positive_until(d),
                   detail::positive_until(add(n, multiply(minus_6px, d))),
                   detail::positive_until(add(slope, multiply(minus_6px, multiply(d, d))))});
}

}  // namespace

DistortionModel distortion_model(std::string_view name) {
  if (name.empty() || name == "none") return DistortionModel::none;
  if (name == "plumb_bob") return DistortionModel::plumb_bob;
  if (name == "rational_polynomial") return DistortionModel::rational_polynomial;
  if (name == "equidistant" || name == "fisheye" || name == "kannala_brandt4")
    return DistortionModel::equidistant;
  throw InputError("distortion model \"" + std::string(name) +
                   "\" is unknown; known are plumb_bob, rational_polynomial, equidistant "
                   "(also called fisheye, kannala_brandt4) and none");
}

std::string_view to_string(DistortionModel model) {
  switch (model) {
    case DistortionModel::plumb_bob:
      return "plumb_bob";
    case DistortionModel::rational_polynomial:
      return "rational_polynomial";
    case DistortionModel::equidistant:
      return "equidistant";
    case DistortionModel::none:
      break;
  }
  return "none";
}

Distortion::Distortion(std::string_view name, std::span<const double> k)
    : model_(distortion_model(name)) {
  check_coefficients(model_, name, k);
  if (model_ != DistortionModel::equidistant && all_zero(k)) model_ = DistortionModel::none;
  if (model_ == DistortionModel::none) return;

  if (model_ == DistortionModel::equidistant) {
    std::copy(k.begin(), k.end(), numerator_.begin() + 1);
  } else {
    numerator_ = {1, k[0], k[1], k.size() > 4 ? k[4] : 0.0, 0};
    if (k.size() > 5) denominator_ = {1, k[5], k[6], k[7]};
    tangential_ = {k[3], k[2]};
  }
  constexpr double off_the_root = 1 - 1e-9;  // by more than rounding, so that no pole is crossed
  const double end = off_the_root * monotone_until(in_squares(numerator_), in_squares(denominator_),
                                                   tangential_.norm());
  if (model_ != DistortionModel::equidistant)
    max_radius_ = end;
  else if (end < right_angle)
    max_radius_ = std::tan(end);
}

Eigen::Vector2d Distortion::distort(const Eigen::Vector2d& z) const {
  if (is_none()) return z;
  const double r2 = z.squaredNorm();
  if (model_ == DistortionModel::equidistant) {
    const double r = std::sqrt(r2);
    return r > 0 ? Eigen::Vector2d(z * (radial(std::atan(r)) / r)) : z;
  }
  const double factor = horner(numerator_, r2) / horner(denominator_, r2);
  return z * (factor + 2 * tangential_.dot(z)) + tangential_ * r2;
}

Eigen::Matrix2d Distortion::derivative(const Eigen::Vector2d& z) const {
  const double r = z.norm();
  if (is_none() || !(r > 0)) return Eigen::Matrix2d::Identity();
  const bool by_angle = model_ == DistortionModel::equidistant;
  const double parameter = by_angle ? std::atan(r) : r;
  const double along = radial_derivative(parameter) / (by_angle ? 1 + r * r : 1.0);
  const double across = radial(parameter) / r;
  const Eigen::Vector2d unit = z / r;
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  return across * identity + (along - across) * unit * unit.transpose() +
         2 * (tangential_.dot(z) * identity + z * tangential_.transpose() +
              tangential_ * z.transpose());
}

std::optional<Eigen::Vector2d> Distortion::undistort(const Eigen::Vector2d& y) const {
  if (is_none()) return y;
  if (y == Eigen::Vector2d::Zero()) return y;
  if (!y.allFinite()) return std::nullopt;
  constexpr double far_away = 1e9;  // of the plane z = 1: no lens puts a ray there
  double end = max_parameter();
  if (!std::isfinite(end))
    for (end = 1; end < far_away && !(excess(end, y) > 0);) end *= 2;
  if (!(excess(end, y) > 0)) return std::nullopt;

  const double parameter = solve(y, end);
  const Eigen::Vector2d w = y - tangential_ * (parameter * parameter);
  const double r = model_ == DistortionModel::equidistant ? std::tan(parameter) : parameter;
  return Eigen::Vector2d(w.normalized() * r);
}

/// Distorted radius f at the parameter.
double Distortion::radial(double parameter) const {
  const double s = parameter * parameter;
  return parameter * horner(numerator_, s) / horner(denominator_, s);
}

double Distortion::radial_derivative(double parameter) const {
  const double s = parameter * parameter;
  const double n = horner(numerator_, s);
  const double d = horner(denominator_, s);
  return n / d +
         2 * s * (horner_derivative(numerator_, s) * d - n * horner_derivative(denominator_, s)) /
             (d * d);
}

/// How far the image of the circle at the parameter reaches beyond the distorted point: negative
/// where the point lies outside of it.
double Distortion::excess(double parameter, const Eigen::Vector2d& y) const {
  const double s = parameter * parameter;
  const Eigen::Vector2d w = y - tangential_ * s;
  const double length = w.norm();
  const double tangential = length > 0 ? 2 * s * tangential_.dot(w) / length : 0.0;
  return radial(parameter) + tangential - length;
}

double Distortion::excess_derivative(double parameter, const Eigen::Vector2d& y) const {
  const Eigen::Vector2d w = y - tangential_ * (parameter * parameter);
  const double length = w.norm();
  if (!(length > 0)) return radial_derivative(parameter);
  const double along = tangential_.dot(w) / length;
  const double across2 = tangential_.squaredNorm() - along * along;
  const double cube = parameter * parameter * parameter;
  return radial_derivative(parameter) + 6 * parameter * along - 4 * cube * across2 / length;
}

double Distortion::max_parameter() const {
  return model_ == DistortionModel::equidistant ? std::min(std::atan(max_radius_), right_angle)
                                                : max_radius_;
}

/// The parameter of the distorted point, which is less than `end`: Newton's steps, and halving of
/// the bracket where a step leaves it or gains less than halving would.
double Distortion::solve(const Eigen::Vector2d& y, double end) const {
  constexpr int max_steps = 200;       // halving alone needs fewer
  constexpr double precision = 4e-16;  // two units in the last place
  double low = 0;
  double high = end;
  double x = std::min(y.norm(), 0.5 * end);
  double last_step = high;
  for (int i = 0; i < max_steps; ++i) {
    const double value = excess(x, y);
    if (value == 0) break;
    (value < 0 ? low : high) = x;
    double next = x - value / excess_derivative(x, y);
    if (!(next > low && next < high) || std::abs(next - x) > 0.5 * last_step)
      next = 0.5 * (low + high);
    last_step = std::abs(next - x);
    if (next == x || last_step <= precision * x) break;
    x = next;
  }
  return x;
}

}  // namespace penumbra
