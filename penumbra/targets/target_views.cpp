// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/SVD>

#include <penumbra/base/error.hpp>
#include <penumbra/targets/extent_tally.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {
namespace {

/// Returns the depth at a pixel; 0 without a measurement.
double metres_at(const DepthView& depth, const labelling::Rule& rule,
                 const Eigen::Vector2d& pixel) {
  return std::visit(
      [&](const auto& image) {
        const double u = std::round(pixel.x()), v = std::round(pixel.y());
        if (!(u >= 0.0 && v >= 0.0 && u < image.width && v < image.height)) return 0.0;
        const Measured measured(image, rule);
        return static_cast<double>(measured.row(static_cast<int>(v))[static_cast<int>(u)]);
      },
      depth);
}

/// Returns whether the depth at a pixel is trusted; pixels outside the image have none.
bool shows_target(const ImageView<const std::uint8_t>& labels, const Eigen::Vector2d& pixel) {
  const double u = std::round(pixel.x()), v = std::round(pixel.y());
  if (!(u >= 0.0 && v >= 0.0 && u < labels.width && v < labels.height)) return true;
  return is_trusted(static_cast<Label>(labels(static_cast<int>(u), static_cast<int>(v))));
}

/// Fraction of the covered angle by which the outermost covered pixels may fall short.
constexpr double outermost_rays = 1e-3;

constexpr const char* outside_lens =
    "reaches outside the lens model or the pinhole image, where it cannot be rendered";

std::optional<double> drawn_half_angle(const Camera& camera, const Rectification& rectification) {
  const auto drawn = rectification.raw_to_pinhole();
  bool is_whole = true;
  for (int v = 0; v < drawn.height; ++v)
    is_whole = is_whole && std::find(drawn.row(v), drawn.row(v) + drawn.width,
                                     Rectification::no_pixel) == drawn.row(v) + drawn.width;
  if (is_whole) return std::nullopt;
  return (1.0 - outermost_rays) *
         std::min(rectification.half_angle(), std::atan(camera.distortion.max_radius()));
}

bool shows_anything(const VirtualDepthView& view) {
  bool found = false;
  view.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1 && !found; ++v)
      found = std::any_of(view.depth.row(v) + u0, view.depth.row(v) + u1,
                          [](float z) { return z > 0.0F; });
  });
  return found;
}

}  // namespace

Eigen::Isometry3d pose_of(const ReferenceFrame& frame, const PoseResult& poses,
                          const Robot& robot) {
  if (frame.kind == ReferenceFrame::Kind::camera) return poses.T_root_camera;
  if (frame.kind == ReferenceFrame::Kind::root) return Eigen::Isometry3d::Identity();
  const auto link = robot.find_link(frame.link);
  if (!link) throw InputError("'" + frame.link + "' is not a link of robot '" + robot.name() + "'");
  if (poses.is_uncertain(*link))
    throw InputError("the pose of its link '" + frame.link +
                     "' is not known: " + poses.uncertain_reason);
  return poses.T_root_link[*link];
}

std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector3d& p) {
  if (!(p.z() >= DepthRenderer::near_plane) || !p.allFinite()) return std::nullopt;
  const Eigen::Vector2d ray = p.head<2>() / p.z();
  if (ray.norm() >= camera.distortion.max_radius()) return std::nullopt;
  const Eigen::Vector2d bent = camera.distortion.distort(ray);
  return camera.intrinsics.project({bent.x(), bent.y(), 1.0});
}

TargetViews::TargetViews(const Robot& robot, const Camera& camera, ObjectRenderers& renderers,
                         const LabelRule& rule, const Rectification* rectification)
    : robot_(robot), camera_(camera), renderers_(renderers), rule_(rule) {
  if (rectification != nullptr) drawn_half_angle_ = drawn_half_angle(camera, *rectification);
}

/// Makes the view of each kind of shape; returns false if it is outside the camera's view.
struct TargetViews::Builder {
  TargetViews& views;
  const LabelledImages& images;
  const PoseResult& poses;
  TargetView view;

  bool operator()(const std::monostate&) { throw InputError("not found in this frame"); }

  bool operator()(const RegionTarget& target) {
    view.region = target.region;
    view.extent = target.extent;
    view.expected_depth = target.expected_depth;
    view.height = target.height;
    return true;
  }

  bool operator()(const KeypointTarget& target) {
    if (!(target.score >= target.min_score))  // also NaN
      region_fault("score ", target.score, " is below ", target.min_score);
    view.expected_depth = target.expected_depth;
    view.point_pixel = target.pixel;
    PixelEllipse ellipse{target.pixel, target.semi_axes, target.angle};
    if (target.in_metres) ellipse.semi_axes *= most_pixels_per_metre(target);
    view.region = ellipse;
    return true;
  }

  /// Returns the scale along the direction of the lens's largest stretch.
  [[nodiscard]] double most_pixels_per_metre(const KeypointTarget& target) const {
    if (!target.expected_depth && !shows_target(images.labels.labels, target.pixel))
      throw InputError(
          "its size is in metres, but the depth at its pixel may be the robot's; give an expected "
          "depth");
    const double depth =
        target.expected_depth.value_or(metres_at(images.measured, views.rule_, target.pixel));
    if (!(depth > 0.0))
      throw InputError("its size is in metres, but its pixel has no depth; give an expected depth");
    const Camera& camera = views.camera_;
    const auto ray = camera.distortion.undistort(
        camera.intrinsics.ray(target.pixel.x(), target.pixel.y()).head<2>());
    if (!ray) throw InputError("its size is in metres, but its pixel is outside the lens model");
    const Eigen::JacobiSVD<Eigen::Matrix2d> svd(views.pixels_per_metre(*ray, depth));
    return svd.singularValues()[0];
  }

  bool operator()(const PointTarget& target) {
    const Eigen::Vector3d p = T_camera(target.frame) * target.position;
    views.check_is_drawn(p, target.radius);
    const auto pixel = views.project(p);
    if (!pixel) return false;
    view.region = views.ellipse_of(p, target.radius);
    view.expected_depth = p.z();
    view.depth_margin += target.radius;
    view.point_pixel = pixel;
    return true;
  }

  bool operator()(const BoxTarget& target) {
    const Eigen::Isometry3d T = T_camera(target.frame) * target.pose;
    views.check_is_drawn(T.translation(), 0.5 * target.size.norm());
    return rendered(views.renderers_.box(target.size, T)) ||
           nearest_pixel(T.translation(), 0.5 * target.size.norm());
  }

  bool operator()(const MeshTarget& target) {
    const Eigen::Isometry3d T = T_camera(target.frame) * target.pose;
    const bool is_shown = rendered(views.renderers_.mesh(target.mesh, T));
    if (is_shown && !views.drawn_half_angle_) return true;
    const Eigen::AlignedBox3d& bounds = target.mesh->bounds;
    const Eigen::Vector3d middle = T * bounds.center();
    const double radius = 0.5 * bounds.diagonal().norm();
    views.check_is_drawn(middle, radius);
    return is_shown || nearest_pixel(middle, radius);
  }

  bool rendered(const VirtualDepthView& object) {
    view.region = RenderedRegion{object.depth, object.touched};
    return shows_anything(object);
  }

  /// Uses the pixel nearest to the centre for an object that covers no pixel's centre, if that
  /// pixel is in the image and the object is not larger than it.
  bool nearest_pixel(const Eigen::Vector3d& middle, double radius) {
    const auto pixel = views.project(middle);
    if (!pixel || !is_inside(*pixel)) return false;
    const PixelEllipse ellipse = views.ellipse_of(middle, radius);
    if (ellipse.semi_axes.maxCoeff() > 1.0)
      throw InputError(
          "it covers no pixel although its centre is in the image: too thin, or hollow");
    view.region = ellipse;
    view.expected_depth = middle.z();
    view.depth_margin += radius;
    view.point_pixel = pixel;
    return true;
  }

  [[nodiscard]] bool is_inside(const Eigen::Vector2d& pixel) const {
    const Intrinsics& size = views.camera_.intrinsics;
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < size.width() - 0.5 &&
           pixel.y() < size.height() - 0.5;
  }

  [[nodiscard]] Eigen::Isometry3d T_camera(const ReferenceFrame& of) const {
    if (of.kind == ReferenceFrame::Kind::camera) return Eigen::Isometry3d::Identity();
    return poses.T_root_camera.inverse() * pose_of(of, poses, views.robot_);
  }
};

std::optional<TargetView> TargetViews::view(const Target& target, const LabelledImages& images,
                                            const PoseResult& poses) {
  Builder builder{*this, images, poses, {}};
  builder.view.thresholds = target.thresholds;
  builder.view.depth_margin = target.depth_margin;
  if (!std::visit(builder, target.shape)) return std::nullopt;
  return builder.view;
}

/// Throws InputError if a sphere may reach outside the rendered cone.
void TargetViews::check_is_drawn(const Eigen::Vector3d& middle, double radius) const {
  if (!drawn_half_angle_) return;
  const double depth_in_cone = middle.z() * std::sin(*drawn_half_angle_) -
                               middle.head<2>().norm() * std::cos(*drawn_half_angle_);
  if (!(depth_in_cone >= radius)) throw InputError(outside_lens);
}

/// Returns the derivative of a point's pixel by its position parallel to the image plane.
Eigen::Matrix2d TargetViews::pixels_per_metre(const Eigen::Vector2d& ray, double depth) const {
  const Intrinsics& k = camera_.intrinsics;
  return Eigen::Vector2d(k.fx(), k.fy()).asDiagonal() * camera_.distortion.derivative(ray) / depth;
}

/// Returns the outline of a sphere. On the plane z = 1 it is the ellipse where the cone around the
/// sphere intersects the plane (Eberly, "Perspective projection of a sphere"). Lens distortion is
/// linearised at its centre.
PixelEllipse TargetViews::ellipse_of(const Eigen::Vector3d& p, double radius) const {
  if (p.z() <= radius) throw InputError("it reaches the plane of the camera's lens");
  const double depth_squared = p.z() * p.z() - radius * radius;
  const Eigen::Vector2d centre = p.head<2>() * p.z() / depth_squared;
  const double across = radius / std::sqrt(depth_squared);
  const double along = across * std::sqrt((p.squaredNorm() - radius * radius) / depth_squared);
  const auto pixel = project({centre.x(), centre.y(), 1.0});
  if (!pixel) throw InputError(outside_lens);
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(std::atan2(p.y(), p.x())).toRotationMatrix() *
                               Eigen::Vector2d(along, across).asDiagonal();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(pixels_per_metre(centre, 1.0) * axes,
                                              Eigen::ComputeFullU);
  const Eigen::Vector2d axis = svd.matrixU().col(0);
  return {*pixel, svd.singularValues(), std::atan2(axis.y(), axis.x())};
}

}  // namespace penumbra
