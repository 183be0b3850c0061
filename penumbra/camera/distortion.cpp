// SPDX-License-Identifier: Apache-2.0
// With z = (x, y), r = |z|, p = (p2, p1) and the radial factor R, the polynomial models are
//   distort(z) = z R(r^2) + 2 (p . z) z + p r^2.
// The derivative is symmetric. It is the sum of a radial part with the eigenvalues f'(r) and f(r) /
// r, where f(r) = r R(r^2), and of a tangential part between -6 |p| r and 6 |p| r. It is positive
// definite, and distort() one-to-one on the disc, while f' and f / r exceed 6 |p| r.
// The images of the circles |z| = r are then nested, and z is parallel to w = y - p r^2 for
// y = distort(z). One unknown remains: r is the root of f(r) + 2 r^2 p . w / |w| - |w|.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

bool all_zero(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double k) { return k == 0; });
}

struct ModelRow {
  DistortionModel model;
  std::string_view name;
  std::string_view expected;  // coefficients
  std::array<std::size_t, 3> counts;
};

constexpr ModelRow models[] = {
    {DistortionModel::none, "none", "only coefficients that are 0", {}},
    {DistortionModel::plumb_bob, "plumb_bob", "5 (k1 k2 p1 p2 k3) or 4", {4, 5}},
    {DistortionModel::rational_polynomial,
     "rational_polynomial",
     "8 (k1 k2 p1 p2 k3 k4 k5 k6)",
     {8, 12, 14}},
    {DistortionModel::equidistant, "equidistant", "4 (k1 k2 k3 k4)", {4}}};

const ModelRow& row_of(DistortionModel model) { return models[static_cast<std::size_t>(model)]; }

void check_coefficients(DistortionModel model, std::string_view name, std::span<const double> k) {
  const auto& counts = row_of(model).counts;
  const bool fits =
      model == DistortionModel::none
          ? all_zero(k)
          : !k.empty() && std::find(counts.begin(), counts.end(), k.size()) != counts.end();
  std::ostringstream what;
  what << "distortion model \"" << name << "\": ";
  const auto odd = std::find_if(k.begin(), k.end(), [](double c) { return !std::isfinite(c); });
  if (odd != k.end()) {
    what << "coefficient " << odd - k.begin() + 1 << " is " << *odd << ", not a finite number";
  } else if (!fits) {
    what << "it has " << k.size() << " coefficients and needs " << row_of(model).expected;
  } else if (model == DistortionModel::rational_polynomial && !all_zero(k.subspan(8))) {
    what << "coefficients 9 to " << k.size()
         << " (thin prism, tilt) are not supported and must be 0";
  } else {
    return;
  }
  throw InputError(what.str());
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

}  // namespace

DistortionModel distortion_model(std::string_view name) {
  if (name.empty()) return DistortionModel::none;
  if (name == "fisheye" || name == "kannala_brandt4") return DistortionModel::equidistant;
  for (const ModelRow& row : models)
    if (row.name == name) return row.model;
  throw InputError("distortion model \"" + std::string(name) +
                   "\" is unknown; known are plumb_bob, rational_polynomial, equidistant "
                   "(also called fisheye, kannala_brandt4) and none");
}

std::string_view to_string(DistortionModel model) { return row_of(model).name; }

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
  max_parameter_ = find_max_parameter();
  if (model_ != DistortionModel::equidistant)
    max_radius_ = max_parameter_;
  else if (max_parameter_ < right_angle)
    max_radius_ = std::tan(max_parameter_);
}

std::vector<double> Distortion::coefficients() const {
  const auto& n = numerator_;
  const auto& d = denominator_;
  switch (model_) {
    case DistortionModel::none:
      return {};
    case DistortionModel::plumb_bob:
      return {n[1], n[2], tangential_.y(), tangential_.x(), n[3]};
    case DistortionModel::rational_polynomial:
      return {n[1], n[2], tangential_.y(), tangential_.x(), n[3], d[1], d[2], d[3]};
    case DistortionModel::equidistant:
      break;
  }
  return {n[1], n[2], n[3], n[4]};
}

/// Searches the first parameter where the conditions above fail, in small steps and by bisection.
double Distortion::find_max_parameter() const {
  constexpr double step = 1e-3;
  constexpr double largest_radius = 100;     // 89.4 degrees
  constexpr double off_the_root = 1 - 1e-9;  // keeps rounding away from a pole
  const double limit = model_ == DistortionModel::equidistant ? right_angle : largest_radius;
  const double tangential = 6 * tangential_.norm();
  const auto is_monotone = [&](double x) {
    return horner(denominator_, x * x) > 0 && radial(x) > tangential * x * x &&
           radial_derivative(x) > tangential * x;
  };
  double low = 0;
  double high = step;
  for (; is_monotone(high); high += step * (1 + high)) {
    if (high >= limit) return limit;
    low = high;
  }
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (low + high);
    (is_monotone(middle) ? low : high) = middle;
  }
  return std::min(low * off_the_root, limit);
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
  if (!(excess(max_parameter_, y) > 0)) return std::nullopt;

  const double parameter = solve(y, max_parameter_);
  const Eigen::Vector2d w = y - tangential_ * (parameter * parameter);
  const double r = model_ == DistortionModel::equidistant ? std::tan(parameter) : parameter;
  return Eigen::Vector2d(w.normalized() * r);
}

/// Returns the distorted radius f at the parameter.
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

/// Returns how far the image of the circle at the parameter extends beyond the distorted point;
/// negative if the point lies outside of it.
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

/// Returns the parameter of the distorted point, which is less than `end`, by Newton's method, with
/// bisection where a step leaves the bracket or converges slowly.
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
