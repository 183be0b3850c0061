// SPDX-License-Identifier: Apache-2.0
// What almost every test uses.
#pragma once

#include "errors.hpp"
#include "pixels.hpp"
#include "random.hpp"
#include "run_length.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace penumbra::test {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Translation3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double inf = std::numeric_limits<double>::infinity();
inline constexpr std::int64_t ms = 1'000'000;  // nanoseconds

/// A pose that is only moved.
[[nodiscard]] inline Isometry3d at(const Vector3d& position) {
  return Isometry3d(Translation3d(position));
}
[[nodiscard]] inline Isometry3d at(double x, double y, double z) { return at(Vector3d(x, y, z)); }

/// A camera that looks at a point, the root's z upwards in its image.
[[nodiscard]] inline Isometry3d looking_at(const Vector3d& from, const Vector3d& to) {
  const Vector3d z = (to - from).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  Isometry3d T = at(from);
  T.linear() << x, z.cross(x), z;
  return T;
}

/// Where a ray enters a box about the origin, in lengths of the ray; nothing if it does not, 0 if
/// it begins inside.
[[nodiscard]] inline std::optional<double> enter_box(const Vector3d& from, const Vector3d& ray,
                                                     const Vector3d& half_size) {
  const Eigen::Array3d a = (-half_size - from).array() / ray.array();
  const Eigen::Array3d b = (half_size - from).array() / ray.array();
  const double near = std::max(a.min(b).maxCoeff(), 0.0), far = a.max(b).minCoeff();
  return near < far ? std::optional(near) : std::nullopt;
}

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A number from 0 to end - 1.
inline std::size_t below(std::mt19937_64& random, std::size_t end) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

/// Each part between -size and size.
inline Vector3d random_triple(std::mt19937_64& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

inline Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random);
  return Vector3d(x, y, normal(random)).normalized();
}

}  // namespace penumbra::test
