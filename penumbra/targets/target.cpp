// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/targets/region_spans.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {
namespace {

void check_length(double value, const char* what, double most, const char* unit) {
  if (!(value > 0.0 && value <= most))
    region_fault(what, " is ", value, "; expected ", unit, " above 0 and up to ", most);
}

// Metres, of what stands upright; of a shape with the camera inside, and of an outline.
constexpr double tallest_target = 50.0, largest_target = 10.0;

void check_metres(double value, const char* what, double most = max_target_distance) {
  if (value > most) region_fault(what, " is ", value, " m: are these millimetres? give metres");
  check_length(value, what, most, "metres");
}

void check_position(const Eigen::Vector3d& p) {
  if (p.allFinite() && p.cwiseAbs().maxCoeff() <= max_target_distance) return;
  throw InputError("position is not finite, or more than 1000 km away; expected metres");
}

void check_pose(const Eigen::Isometry3d& T) {
  if (!is_rigid(T))
    throw InputError(
        "pose is not a rigid transform: expected a rotation (a unit quaternion) and a finite "
        "position in metres");
  check_position(T.translation());
}

/// Whether a region lies within the first pixel, as one in fractions of the image does.
struct FirstPixel {
  static bool holds(const Eigen::Vector2d& at) {
    return at.minCoeff() >= 0.0 && at.maxCoeff() <= 1.0;
  }
  bool operator()(const PixelBox& box) const {
    return holds({box.u, box.v}) && holds({box.width, box.height});
  }
  bool operator()(const PixelPolygon& polygon) const {
    return !polygon.corners.empty() && std::ranges::all_of(polygon.corners, holds);
  }
  bool operator()(const PixelEllipse& ellipse) const {
    return holds(ellipse.centre) && holds(ellipse.semi_axes);
  }
  bool operator()(const auto& /*mask*/) const { return false; }
};

void check_pixels(bool is_first) {
  if (is_first)
    throw InputError(
        "lies within the first pixel: is it in fractions of the image? expected pixels");
}

struct ShapeCheck {
  void operator()(const std::monostate&) const {}

  void operator()(const RegionTarget& target) const {
    if (target.expected_depth)
      check_metres(*target.expected_depth, "expected depth", farthest_target);
    if (target.height) check_metres(*target.height, "height", tallest_target);
    check_pixels(std::visit(FirstPixel{}, target.region));
  }

  void operator()(const KeypointTarget& target) const {
    if (target.expected_depth)
      check_metres(*target.expected_depth, "expected depth", farthest_target);
    for (const double at : target.pixel)
      if (!(std::abs(at) <= max_coordinate))
        region_fault("pixel is ", at, "; expected at most ", max_coordinate);
    check_pixels(FirstPixel::holds(target.pixel));
    for (const double semi_axis : target.semi_axes)
      if (target.in_metres)
        check_metres(semi_axis, "semi-axis", largest_target);
      else
        check_length(semi_axis, "semi-axis", max_coordinate, "pixels");
    constexpr double most_radians = 1e6;  // radians; a double's rounding is 1e-10 there
    if (!(std::abs(target.angle) <= most_radians))
      region_fault("angle is ", target.angle, " rad; expected at most ", most_radians);
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
  bool is_in_camera;  ///< given in the camera's frame

  void operator()(const std::monostate&) const {}
  void operator()(const Eigen::Vector3d& position) const {
    check_position(position);
    check_distance(position);
  }
  void operator()(const Eigen::Isometry3d& pose) const {
    check_pose(pose);
    check_distance(pose.translation());
  }
  /// An estimate computed from depth 0 (no measurement) lies in the camera's centre.
  void check_distance(const Eigen::Vector3d& position) const {
    constexpr double least = DepthRenderer::near_plane;
    if (!is_in_camera || position.norm() >= least) return;
    region_fault("position is ", position.norm(), " m from the camera; expected at least ", least,
                 " m: depth 0 is not a measurement");
  }
};

std::string metres_text(double length) {
  std::ostringstream text;
  text << std::setprecision(4) << length << " m";
  return text.str();
}

Eigen::AlignedBox3d bounds_of(const TargetShape& shape) {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  if (const auto* mesh = std::get_if<MeshTarget>(&shape); mesh != nullptr && mesh->mesh)
    return mesh->mesh->bounds;
  if (const auto* point = std::get_if<PointTarget>(&shape)) half.setConstant(point->radius);
  if (const auto* box = std::get_if<BoxTarget>(&shape)) half = 0.5 * box->size;
  return {-half, half};
}

}  // namespace

std::optional<ShapePlacement> placement_of(const TargetShape& shape) {
  if (const auto* point = std::get_if<PointTarget>(&shape))
    return {{Eigen::Isometry3d(Eigen::Translation3d(point->position)), point->frame}};
  if (const auto* box = std::get_if<BoxTarget>(&shape)) return {{box->pose, box->frame}};
  if (const auto* mesh = std::get_if<MeshTarget>(&shape)) return {{mesh->pose, mesh->frame}};
  return std::nullopt;
}

void place(TargetShape& shape, const ShapePlacement& at) {
  if (auto* point = std::get_if<PointTarget>(&shape)) {
    point->position = at.pose.translation();
    point->frame = at.frame;
  }
  const auto set = [&](auto* solid) {
    if (solid == nullptr) return;
    solid->pose = at.pose;
    solid->frame = at.frame;
  };
  set(std::get_if<BoxTarget>(&shape));
  set(std::get_if<MeshTarget>(&shape));
}

bool is_rendered(const TargetShape& shape) {
  return std::holds_alternative<BoxTarget>(shape) || std::holds_alternative<MeshTarget>(shape);
}

void check_shape(const TargetShape& shape) { std::visit(ShapeCheck{}, shape); }

void check_distance(const Target& target,
                    const std::function<Eigen::Isometry3d(const ReferenceFrame&)>& T_camera_frame) {
  std::string line;
  const auto check_distance = [&](double distance) {
    if (line.empty() && distance > farthest_target)
      line = "it is " + metres_text(distance) + " away from the camera";
  };
  try {
    if (const auto at = placement_of(target.shape)) {
      const Eigen::Isometry3d T_camera_shape = T_camera_frame(at->frame) * at->pose;
      const Eigen::AlignedBox3d bounds = bounds_of(target.shape);
      check_distance((T_camera_shape * bounds.center()).norm());
      const double size = bounds.sizes().maxCoeff();
      if (line.empty() && size > largest_target &&
          bounds.contains(T_camera_shape.inverse().translation().eval()))
        line = "it is " + metres_text(size) + " large, and the camera is inside of it";
    }
    if (target.estimate && !std::holds_alternative<std::monostate>(target.estimate->value)) {
      const auto* const pose = std::get_if<Eigen::Isometry3d>(&target.estimate->value);
      const Eigen::Vector3d position =
          pose != nullptr ? pose->translation() : std::get<Eigen::Vector3d>(target.estimate->value);
      check_distance((T_camera_frame(target.estimate->frame) * position).norm());
    }
  } catch (const InputError&) {  // the frame's pose is not known
  }
  if (!line.empty()) throw InputError(line + ": are these millimetres? give metres");
}

void check_target(const Target& target) {
  if (target.name.empty()) throw InputError("has no name");
  if (!target.has_identity && !std::holds_alternative<std::monostate>(target.handling))
    throw InputError("handling needs a name that stays with its object (has_identity)");
  target.thresholds.check();
  if (is_rendered(target.shape) && target.thresholds.min_inside > 0)
    throw InputError(
        "min_inside cannot be used with 3-D boxes and meshes, whose part outside the image is "
        "unknown: leave it out");
  if (target.depth_margin != 0.0) check_metres(target.depth_margin, "depth margin", largest_target);
  check_shape(target.shape);
}

void check_estimate(const TargetEstimate& estimate) {
  std::visit(EstimateCheck{estimate.frame.kind == ReferenceFrame::Kind::camera}, estimate.value);
}

}  // namespace penumbra
