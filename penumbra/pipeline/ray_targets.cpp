// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/scan_labeller-inl.hpp>
#include <penumbra/targets/extent_tally.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {
namespace {

/// A box or ball, and rays from one origin.
class RayTarget {
 public:
  RayTarget(const TargetShape& shape, const Eigen::Isometry3d& T_points_frame,
            const Eigen::Vector3d& origin) {
    if (const auto* box = std::get_if<BoxTarget>(&shape)) {
      half_ = 0.5 * box->size;
      radius_ = half_.norm();
      place(T_points_frame * box->pose, origin);
    } else if (const auto* ball = std::get_if<PointTarget>(&shape)) {
      radius_ = ball->radius;
      is_ball_ = true;
      place(T_points_frame * Eigen::Isometry3d(Eigen::Translation3d(ball->position)), origin);
    } else {
      throw InputError("only 3-D boxes and points are judged on clouds");
    }
  }

  /// Whether a ray, of any length, may meet the ball around the target.
  [[nodiscard]] bool may_meet(const Eigen::Vector3f& ray) const {
    const float along = ray.dot(centre_);
    return tangent_ <= 0.0F || (along > 0.0F && along * along >= tangent_ * ray.squaredNorm());
  }

  /// Metres by which the target may be nearer or farther.
  [[nodiscard]] double margin() const { return is_ball_ ? radius_ : 0.0; }

  /// Returns the range at which a ray of length 1 enters the box, or passes the ball's centre; the
  /// ray meets the ball around it.
  [[nodiscard]] std::optional<double> entry(const Eigen::Vector3d& ray) const {
    if (is_ball_) return ray.dot(to_centre_);
    const Eigen::Array3d direction = (R_box_points_ * ray).array();
    const Eigen::Array3d a = (-half_ - origin_).array() / direction,
                         b = (half_ - origin_).array() / direction;
    const double enters = a.min(b).maxCoeff(), leaves = a.max(b).minCoeff();
    if (!(enters < leaves) || leaves < 0.0) return std::nullopt;
    return std::max(enters, 0.0);
  }

 private:
  void place(const Eigen::Isometry3d& T_points_shape, const Eigen::Vector3d& origin) {
    to_centre_ = T_points_shape.translation() - origin;
    R_box_points_ = T_points_shape.linear().transpose();
    origin_ = -R_box_points_ * to_centre_;
    centre_ = to_centre_.cast<float>();
    constexpr double room = 1e-4;  // of float32, with room
    tangent_ = static_cast<float>((1.0 - room) * to_centre_.squaredNorm() - radius_ * radius_);
  }

  Eigen::Vector3d half_ = Eigen::Vector3d::Zero(), to_centre_, origin_;  // origin_: in the box
  Eigen::Matrix3d R_box_points_;
  double radius_ = 0.0;  // of a ball around it
  bool is_ball_ = false;
  Eigen::Vector3f centre_ = Eigen::Vector3f::Zero();
  float tangent_ = 0.0F;  // squared length of the ball's tangents from the origin, or less
};

/// A ray's range and label against the ranges at which the target is.
PixelState state_of(Label label, double range, const DepthLimits& limits, bool beyond_hides) {
  const bool is_before = range < static_cast<double>(limits.near);
  switch (label) {
    case Label::clear:
    case Label::front:
      return is_before               ? PixelState::other
             : label == Label::front ? PixelState::front
                                     : PixelState::clear;
    case Label::occluded:
      if (is_before) return PixelState::occluded;
      return range > static_cast<double>(limits.far) ? PixelState::clear : PixelState::unknown;
    case Label::beyond:
      return is_before || beyond_hides ? PixelState::occluded : PixelState::clear;
    default:
      return PixelState::unknown;
  }
}

}  // namespace

/// Judges a 3-D box, or a point with its radius, as TargetJudge does, each ray that meets it in
/// place of a pixel. Rays without a measurement do not exist.
Judgement ScanLabeller::judge(const LabelledFrame& frame, const Target& target,
                              TargetMemory* memory,
                              const std::optional<Eigen::Vector2d>& /*motion*/) {
  const LabelledImages& images = frame.images;
  const Scan& scan = *frame.scan;
  if (images.labels.labels.empty()) throw InputError(frame.fault());
  if (!scan.origin) throw InputError("clouds without rays do not show what is hidden");
  const Eigen::Vector3d& origin = *scan.origin;
  const auto at = placement_of(target.shape).value_or(ShapePlacement());
  const RayTarget shape(
      target.shape, frame.poses->T_root_camera.inverse() * pose_of(at.frame, *frame.poses, robot_),
      origin);
  const std::uint8_t* const labels = images.labels.labels.data;
  ExtentTally tally(images.link_names.size());
  const Eigen::Vector3f start = origin.cast<float>();
  for (std::size_t i = 0; i < scan.points.count; ++i) {
    const Eigen::Vector3f point = scan.points[i];
    if (!shape.may_meet(point - start)) continue;
    const Eigen::Vector3d ray = point.cast<double>() - origin;
    const double range = ray.norm();
    if (!std::isfinite(range) || range < CloudLabeller::least_range) continue;
    const auto entry = shape.entry(ray / range);
    if (!entry) continue;
    const double margin = config_.rule.tolerance.at(*entry) + target.depth_margin + shape.margin();
    const DepthLimits limits{static_cast<float>(*entry - margin),
                             static_cast<float>(*entry + margin)};
    const PixelState state =
        state_of(static_cast<Label>(labels[i]), range, limits, target.thresholds.beyond_hides);
    tally.covered = ++tally.inside;
    ++tally.pixels[state];
    if (state == PixelState::occluded) tally.links.add(images.virtual_depth.links.data[i], 1);
    if (!is_seen(state)) continue;
    ++tally.measured;
    if (range > static_cast<double>(limits.far)) ++tally.past;
  }
  tally.is_expected = true;
  tally.needed = target.thresholds.point_min_pixels;
  TargetMemory none;
  return judgement_of(tally, images, target.thresholds, memory != nullptr ? *memory : none);
}

}  // namespace penumbra
