// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

std::string written(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void check_length(double value, const char* what, double most, const char* unit) {
  if (value > 0.0 && value <= most) return;
  throw InputError(std::string(what) + " is " + written(value) + "; " + unit + " above 0, up to " +
                   written(most) + ", are wanted");
}

void check_metres(double value, const char* what) {
  check_length(value, what, max_target_distance, "metres");
}

void check_position(const Eigen::Vector3d& p) {
  if (p.allFinite() && p.cwiseAbs().maxCoeff() <= max_target_distance) return;
  throw InputError("position is not finite, or more than 1000 km away; metres are wanted");
}

void check_pose(const Eigen::Isometry3d& T) {
  if (!is_rigid(T))
    throw InputError(
        "pose is no rigid transform: a rotation (a unit quaternion) and a finite position in "
        "metres are wanted");
  check_position(T.translation());
}

struct ShapeCheck {
  void operator()(const std::monostate&) const {}

  void operator()(const RegionTarget& target) const {
    if (target.expected_depth) check_metres(*target.expected_depth, "expected depth");
  }

  void operator()(const KeypointTarget& target) const {
    if (target.expected_depth) check_metres(*target.expected_depth, "expected depth");
    for (const double at : target.pixel)
      if (!(std::abs(at) <= max_coordinate))
        throw InputError("pixel is " + written(at) + "; up to " + written(max_coordinate) +
                         " are possible");
    for (const double semi_axis : target.semi_axes)
      if (target.in_metres)
        check_metres(semi_axis, "semi-axis");
      else
        check_length(semi_axis, "semi-axis", max_coordinate, "pixels");
    constexpr double most_turns = 1e6;  // radians; a double's rounding is 1e-10 there
    if (!(std::abs(target.angle) <= most_turns))
      throw InputError("angle is " + written(target.angle) + " rad; up to a million are possible");
  }

  void operator()(const PointTarget& target) const {
    check_position(target.position);
    check_metres(target.radius, "radius");
  }

  void operator()(const BoxTarget& target) const {
    check_pose(target.pose);
    for (const double edge : target.size) check_metres(edge, "edge of the box");
  }

  void operator()(const MeshTarget& target) const { check_pose(target.pose); }
};

struct EstimateCheck {
  bool has_frame;  ///< other than the camera's

  void operator()(const std::monostate&) const {}
  void operator()(const Eigen::Vector3d& position) const {
    check_position(position);
    check_distance(position);
  }
  void operator()(const Eigen::Isometry3d& pose) const {
    check_pose(pose);
    check_distance(pose.translation());
  }
  /// Depth 0 is no measurement: what is made of it lies in the camera.
  void check_distance(const Eigen::Vector3d& position) const {
    constexpr double least = DepthRenderer::near_plane;
    if (has_frame || position.norm() >= least) return;
    throw InputError("position is " + written(position.norm()) + " m from the camera; at least " +
                     written(least) + " m is wanted: depth 0 is no measurement");
  }
};

}  // namespace

bool is_rendered(const TargetShape& shape) {
  return std::holds_alternative<BoxTarget>(shape) || std::holds_alternative<MeshTarget>(shape);
}

void check_shape(const TargetShape& shape) { std::visit(ShapeCheck{}, shape); }

void check_target(const Target& target) {
  if (target.name.empty()) throw InputError("has no name");
  if (!target.has_identity && !std::holds_alternative<std::monostate>(target.handling))
    throw InputError("handling needs a name that stays with its object: give it an identity");
  target.thresholds.check();
  if (is_rendered(target.shape) && target.thresholds.min_inside > 0)
    throw InputError(
        "min_inside needs to know what lies outside of the image, which is not known of 3-D boxes "
        "and meshes: leave it out");
  if (!(target.depth_margin >= 0.0 && target.depth_margin <= max_target_distance))
    throw InputError("depth margin is " + written(target.depth_margin) +
                     "; metres from 0 up to a million are wanted");
  check_shape(target.shape);
}

void check_estimate(const TargetEstimate& estimate) {
  std::visit(EstimateCheck{estimate.frame.has_value()}, estimate.value);
}

}  // namespace penumbra
