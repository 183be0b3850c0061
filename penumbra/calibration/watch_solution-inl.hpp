// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/calibration/dense.hpp>

namespace penumbra::watching {

// The camera's motion, depth offset and scale, time offset.
constexpr int unknowns = 9, depth_offset = 6, depth_scale = 7, time_offset = 8;
using Vector = Eigen::Matrix<double, unknowns, 1>;
using Matrix = Eigen::Matrix<double, unknowns, unknowns>;

constexpr double independent = 10.0;  // residuals of one view count as so many, at most
constexpr double enough = 0.9;        // of what pose and clocks explain together

/// A link in one place: what puts it out of place there is the same for all of its residuals.
struct View {
  std::size_t link = 0, place = 0, first_frame = 0, count = 0;
  std::size_t index = 0, last_index = 0;  // of the first and last frame in their source
  std::optional<std::int64_t> stamp;      // of the first frame
  Eigen::Isometry3d T_camera_link;
  Matrix information = Matrix::Zero();
  Vector gradient = Vector::Zero();

  [[nodiscard]] double weight() const {
    const auto n = static_cast<double>(count);
    return n > independent ? independent / n : 1.0;
  }
  /// The squares by which the residuals rise from those at zero.
  [[nodiscard]] double rise(const Vector& unknown) const {
    return weight() * unknown.dot(information * unknown + 2.0 * gradient);
  }
};

struct Solution {
  Vector value;
  Matrix covariance;
  Matrix information;
  Vector gradient;

  /// The parts that clocks alone and the pose alone explain of what both explain.
  [[nodiscard]] double by_clocks() const { return share(depth_offset, 3); }
  [[nodiscard]] double by_pose() const { return share(0, 8); }
  /// Which of them is to blame: what explains more if that is enough, else both.
  [[nodiscard]] bool blames_clocks() const { return is_both() || by_clocks() >= by_pose(); }
  [[nodiscard]] bool blames_pose() const { return is_both() || by_pose() > by_clocks(); }
  [[nodiscard]] bool is_both() const { return std::max(by_clocks(), by_pose()) < enough; }
  /// Whether each of them explains enough alone.
  [[nodiscard]] bool is_either() const { return std::min(by_clocks(), by_pose()) >= enough; }

 private:
  [[nodiscard]] double share(int first, int count) const {
    const double sensor = fall(depth_offset, 2);
    return (fall(first, count) - sensor) / (fall(0, unknowns) - sensor);
  }
  /// By how much the squares fall if `count` unknowns from `first` on are free, the others zero.
  [[nodiscard]] double fall(int first, int count) const {
    return dense::squared_sigmas(gradient.segment(first, count),
                                 information.block(first, first, count, count));
  }
};

/// What is expected before anything is measured.
struct Prior {
  Vector value = Vector::Zero();
  Matrix information = Matrix::Zero();

  /// The same if `count` unknowns from `first` on are zero.
  [[nodiscard]] Prior with_zero(int first, int count) const {
    constexpr double certain = 1e12;
    Prior prior = *this;
    prior.value.segment(first, count).setZero();
    prior.information.diagonal().segment(first, count).array() += certain;
    return prior;
  }
};

/// Least squares over views. The covariance is that of sums over places (the sandwich estimator,
/// Huber 1967), with a factor for few of them, and a part of that of independent residuals.
[[nodiscard]] std::optional<Solution> solve(std::vector<const View*> views, const Prior& prior);

}  // namespace penumbra::watching
