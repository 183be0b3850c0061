// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/planning/camera_predictor-inl.hpp>
#include <penumbra/targets/extent_tally.hpp>

namespace penumbra::planning {
namespace {

constexpr int outline_corners = 32;  // of an ellipse, and along each side of a distorted box

std::optional<Rectification> rectification_of(const Camera& camera) {
  if (camera.distortion.is_none()) return std::nullopt;
  return std::optional<Rectification>(std::in_place, camera);
}

Camera rectified(Camera camera, const std::optional<Rectification>& rectification) {
  if (rectification) camera.intrinsics = rectification->pinhole();
  camera.distortion = {};
  return camera;
}

LabelRule within_range(LabelRule rule) {
  rule.range = {};
  return rule;
}

bool is_drawn(const AttachedBody& body) {
  return body.mesh != nullptr && !body.mesh->triangles.empty();
}

std::string why_parts_lack(const Robot& robot, std::span<const AttachedBody> attached) {
  for (const LinkReport& link : robot.report())
    if (link.missing) return "a mesh of link '" + link.link + "' could not be read";
  for (const AttachedBody& body : attached)
    if (!is_drawn(body)) return "the shape of '" + body.name + "' is not known: " + body.reason;
  return {};
}

std::vector<Body> bodies_with(const Robot& robot, std::span<const AttachedBody> attached) {
  std::vector<Body> bodies = bodies_of(robot);
  for (const AttachedBody& body : attached)
    if (is_drawn(body)) bodies.push_back({body.name, {body.mesh.get(), 1}});
  return bodies;
}

/// The outline of a shape in pixels; empty for masks.
std::vector<Eigen::Vector2d> outline_of(const Region& region) {
  std::vector<Eigen::Vector2d> outline;
  if (const auto* polygon = std::get_if<PixelPolygon>(&region)) outline = polygon->corners;
  if (const auto* box = std::get_if<PixelBox>(&region)) {
    const std::array<Eigen::Vector2d, 4> corners{{{box->u, box->v},
                                                  {box->u + box->width, box->v},
                                                  {box->u + box->width, box->v + box->height},
                                                  {box->u, box->v + box->height}}};
    for (std::size_t side = 0; side < corners.size(); ++side)
      for (int i = 0; i < outline_corners; ++i) {
        const double part = static_cast<double>(i) / outline_corners;
        outline.emplace_back((1.0 - part) * corners[side] + part * corners[(side + 1) % 4]);
      }
  }
  if (const auto* ellipse = std::get_if<PixelEllipse>(&region))
    for (int i = 0; i < outline_corners; ++i) {
      const double at = 2.0 * std::numbers::pi * i / outline_corners;
      outline.emplace_back(ellipse->centre +
                           Eigen::Rotation2Dd(ellipse->angle) *
                               Eigen::Vector2d(std::cos(at) * ellipse->semi_axes.x(),
                                               std::sin(at) * ellipse->semi_axes.y()));
    }
  return outline;
}

/// A region or key point, and its depth if that is known.
std::pair<Region, std::optional<double>> region_of(const TargetShape& shape, const Camera& camera) {
  if (const auto* target = std::get_if<KeypointTarget>(&shape)) {
    if (!(target->score >= target->min_score))  // also NaN
      throw InputError("its score is below min_score");
    PixelEllipse ellipse{target->pixel, target->semi_axes, target->angle};
    if (target->in_metres && target->expected_depth)
      ellipse.semi_axes *= camera.intrinsics.fx() / *target->expected_depth;
    return {ellipse, target->expected_depth};
  }
  const auto& target = std::get<RegionTarget>(shape);
  std::optional<double> depth = target.expected_depth;
  if (const auto* box = std::get_if<PixelBox>(&target.region); box && !depth && target.height)
    depth = camera.intrinsics.fy() * *target.height / box->height;
  return {target.region, depth};
}

}  // namespace

AnchoredTarget anchored(const ForecastTarget& given, const Camera& camera,
                        const Eigen::Isometry3d& T_root_camera) {
  check_target(given.target);
  AnchoredTarget anchored{.start = given, .T_root_camera = T_root_camera};
  Target& target = anchored.start.target;
  target.has_identity = false;  // each time is judged alone
  target.handling = {};
  target.estimate.reset();
  const auto at = placement_of(target.shape);
  if (at && at->frame.kind == ReferenceFrame::Kind::camera)
    place(target.shape, {T_root_camera * at->pose, ReferenceFrame::root()});
  if (at || std::holds_alternative<std::monostate>(target.shape)) return anchored;
  const auto [region, depth] = region_of(target.shape, camera);
  if (!depth) return anchored;
  for (const Eigen::Vector2d& pixel : outline_of(region)) {
    const auto ray =
        camera.distortion.undistort(camera.intrinsics.ray(pixel.x(), pixel.y()).head<2>());
    if (!ray) throw InputError("target '" + target.name + "' reaches outside of the lens model");
    anchored.outline.emplace_back(T_root_camera * (*depth * ray->homogeneous()));
  }
  if (auto* shape = std::get_if<RegionTarget>(&target.shape); shape && anchored.outline.empty())
    shape->expected_depth = depth;
  return anchored;
}

CameraPredictor::CameraPredictor(const Robot& robot, const ForecastCamera& camera,
                                 std::span<const AnchoredTarget> targets, const RobotPose& start,
                                 int clearance)
    : robot_(robot),
      rectification_(rectification_of(camera.camera.check())),
      camera_(rectified(camera.camera, rectification_)),
      clearance_(clearance),
      free_(clearance > 0 ? clearance : std::numeric_limits<double>::quiet_NaN()),
      rule_(within_range(camera.rule)),
      label_rule_(rule_),
      poses_(robot, camera.camera.parent, camera.camera.pose(), {}),
      renderer_(make_depth_renderer(Backend::cpu, camera_.intrinsics,
                                    bodies_with(robot, start.attached))),
      near_plane_(camera_.intrinsics, bodies_with(robot, start.attached)),
      always_unknown_(why_parts_lack(robot, start.attached)),
      objects_(camera_.intrinsics, Backend::cpu, {}, nullptr, camera_),
      views_(robot, camera_, objects_, rule_, nullptr),
      seen_pixels_(rectification_ ? UncoveredPixels(rectification_->pinhole_to_raw()).mask()
                                  : ImageView<const std::uint8_t>{}),
      spans_(camera_.intrinsics.width(), camera_.intrinsics.height()),
      tally_(robot.links().size() + max_attached),
      clearance_of_(label_rule_) {
  rule_.check();
  for (const Body& body : bodies_with(robot, start.attached)) {
    names_.emplace_back(body.name);
    bounds_.emplace_back();
    for (const PreparedMesh& mesh : body.meshes) bounds_.back().extend(mesh.bounds);
  }
  images_.evidence = Evidence::assumed_free;
  images_.link_names = names_;
  carried_ = start.attached;
  std::ranges::copy_if(carried_, std::back_inserter(pose_.attached), is_drawn);
  static_cast<void>(set(targets, start));
}

bool CameraPredictor::set(std::span<const AnchoredTarget> targets, const RobotPose& start) {
  const auto is_same = [](const AttachedBody& a, const AttachedBody& b) {
    return a.name == b.name && a.link == b.link && a.mesh == b.mesh &&
           a.T_link_body.matrix() == b.T_link_body.matrix();
  };
  if (!std::ranges::equal(carried_, start.attached, is_same)) return false;
  pose_.uncertain_links = start.uncertain_links;
  pose_.uncertain_reason = start.uncertain_reason;
  pose_.T_parent_camera = start.T_parent_camera;
  anchored_ = targets;
  targets_.clear();
  for (const AnchoredTarget& target : targets) targets_.push_back(target.start.target);
  shown_.assign(targets.size(), {});
  return true;
}

Sample CameraPredictor::at(double time, std::span<const double> positions) {
  pose_.positions.assign(positions.begin(), positions.end());
  const PoseResult& poses = poses_.place(pose_, std::nullopt, FrameStatus::ok, {});
  Sample sample;
  sample.time = time;
  sample.targets.resize(targets_.size());
  sample.predictions.resize(targets_.size());
  // One on a link of unknown pose is not placed.
  if (!poses.known() || poses.attached.size() != pose_.attached.size()) {
    for (Prediction& prediction : sample.predictions) prediction.reason = poses.message;
    return sample;
  }
  place_bodies(poses, sample);
  const PixelRectangle image{0, 0, camera_.intrinsics.width(), camera_.intrinsics.height()};
  PixelRectangle drawn;  // where the robot matters
  std::vector<bool> is_near(targets_.size());
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const PixelRectangle& region = sample.targets[i] = show(i, poses, time).region;
    if (region.empty()) continue;
    const PixelRectangle window = overlap(grown(region, clearance_, clearance_), image);
    is_near[i] = std::ranges::any_of(
        sample.bodies, [&](const SeenBody& body) { return !overlap(body.pixels, window).empty(); });
    if (is_near[i]) drawn = drawn.empty() ? window : drawn.united(window);
  }
  if (!drawn.empty()) images_.virtual_depth = renderer_->render(T_camera_body_, drawn);
  images_.labels.touched = images_.virtual_depth.touched;
  images_.undrawn = unknown_reason_;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const auto is_target = [&](const AttachedBody& body) { return body.name == targets_[i].name; };
    sample.predictions[i] = std::ranges::any_of(pose_.attached, is_target)
                                ? Prediction{.verdict = Verdict::held, .clearance = free_}
                                : judge(i, is_near[i]);
  }
  return sample;
}

void CameraPredictor::place_bodies(const PoseResult& poses, Sample& sample) {
  T_camera_body_ = poses.T_camera_link;
  for (const PlacedBody& body : poses.attached) T_camera_body_.push_back(body.T_camera_body);
  for (std::size_t i = 0; i < bounds_.size(); ++i)
    sample.bodies.push_back(
        {T_camera_body_[i], bounds_[i].isEmpty() || !T_camera_body_[i].matrix().allFinite()
                                ? PixelRectangle{}
                                : pixels_of(bounds_[i], T_camera_body_[i], camera_.intrinsics)});
  unknown_reason_ = always_unknown_.empty() ? poses.message : always_unknown_;
  if (!near_plane_.find(T_camera_body_).empty())
    unknown_reason_ = "a part of the robot is too near to the camera to be drawn";
}

/// Moves a target that no link carries to where it is at a time.
void CameraPredictor::move(std::size_t target, double time) {
  const AnchoredTarget& from = anchored_[target];
  const Eigen::Vector3d way = time * from.start.velocity;
  const Eigen::Vector3d& rate = from.start.angular_velocity;
  const Eigen::AngleAxisd turn(time * rate.norm(), rate.isZero() ? Eigen::Vector3d::UnitX().eval()
                                                                 : rate.normalized().eval());
  const auto at = placement_of(from.start.target.shape);
  if (at && at->frame.kind == ReferenceFrame::Kind::root) {
    Eigen::Isometry3d pose = at->pose;
    pose.linear() = turn * at->pose.linear();
    pose.translation() += way;
    place(targets_[target].shape, {pose, at->frame});
  }
  if (from.outline.empty()) return;
  const Eigen::Vector3d middle =
      std::accumulate(from.outline.begin(), from.outline.end(), Eigen::Vector3d(0, 0, 0)) /
      static_cast<double>(from.outline.size());
  outline_.clear();
  for (const Eigen::Vector3d& corner : from.outline)
    outline_.emplace_back(middle + way + turn * (corner - middle));
}

/// Makes the target's view again if it has moved in the image.
const SeenTarget& CameraPredictor::show(std::size_t target, const PoseResult& poses, double time) {
  SeenTarget& shown = shown_[target];
  const ForecastTarget& start = anchored_[target].start;
  const bool is_at_rest = start.velocity.isZero(0.0) && start.angular_velocity.isZero(0.0);
  try {
    if (!start.target.fault.empty()) throw InputError(start.target.fault);
    if (!start.velocity.allFinite() || !start.angular_velocity.allFinite())
      throw InputError("its velocity is not finite");
    Eigen::Isometry3d T_camera_frame = poses.T_root_camera.inverse();
    if (const auto at = placement_of(start.target.shape))
      T_camera_frame = T_camera_frame * pose_of(at->frame, poses, robot_);
    if (is_at_rest) time = 0.0;
    if (shown.time == time && shown.T_camera_frame.matrix() == T_camera_frame.matrix())
      return shown;
    shown = {.T_camera_frame = T_camera_frame, .time = time};
    move(target, time);
    fill(target, poses, shown);
  } catch (const InputError& error) {
    shown = {.fault = error.what()};
  }
  return shown;
}

void CameraPredictor::fill(std::size_t target, const PoseResult& poses, SeenTarget& shown) {
  const auto is_in_range = [&](double depth) {
    return depth >= camera_.range.near && depth <= camera_.range.far;
  };
  const std::vector<Eigen::Vector3d>& outline = anchored_[target].outline;
  if (!outline.empty()) {
    TargetView view;
    view.depth_margin = targets_[target].depth_margin;
    view.thresholds = targets_[target].thresholds;
    PixelPolygon polygon;
    double depth = 0.0;
    for (const Eigen::Vector3d& corner : outline_) {
      const Eigen::Vector3d p = shown.T_camera_frame * corner;
      if (p.z() < DepthRenderer::near_plane) continue;
      polygon.corners.push_back(camera_.intrinsics.project(p));
      depth += p.z() / static_cast<double>(outline_.size());
    }
    if (polygon.corners.empty()) return;
    if (polygon.corners.size() < outline_.size())
      throw InputError("it reaches the plane of the camera's lens");
    view.region = std::move(polygon);
    view.expected_depth = depth;
    if (is_in_range(depth)) set_extent(view, depth, shown);
    return;
  }
  const auto placement = placement_of(targets_[target].shape);
  double depth = std::numeric_limits<double>::infinity();
  if (placement) {
    depth = (shown.T_camera_frame * placement->pose.translation()).z();
    if (!is_in_range(depth)) return;
  } else if (rectification_ || !poses.T_root_camera.isApprox(anchored_[target].T_root_camera)) {
    throw InputError(
        "its pixels cannot be followed in another camera, one that moves, or one whose lens bends: "
        "give a box or polygon and its expected_depth");
  }
  if (const auto view = views_.view(targets_[target], {}, poses))
    set_extent(*view, placement ? depth : view->expected_depth.value_or(depth), shown);
}

/// Fills in the pixels of the target's region and their depths. `depth`: of its middle, metres;
/// infinite: not known.
void CameraPredictor::set_extent(const TargetView& view, double depth, SeenTarget& shown) {
  check_view(view);
  spans_.fill(view.region);
  spans_.keep(seen_pixels_);
  shown.spans.assign(spans_.spans().begin(), spans_.spans().end());
  if (shown.spans.empty()) return;
  shown.region = box_of_spans(shown.spans);
  shown.covered = spans_.covered();
  shown.inside = spans_.inside();
  if (!std::isfinite(depth)) return;
  shown.before = LimitRule(label_rule_, view.depth_margin).at(static_cast<float>(depth)).near;
  shown.expected.margin = view.depth_margin;
  const auto* const rendered = std::get_if<RenderedRegion>(&view.region);
  if (rendered == nullptr) {
    shown.expected.constant = static_cast<float>(*view.expected_depth);
    return;
  }
  const auto [u0, v0, u1, v1] = shown.region;
  shown.depth = Image<float>(u1 - u0, v1 - v0);
  for (const RowSpan& span : shown.spans)
    std::copy_n(rendered->depth.view.row(span.v) + span.u0, span.u1 - span.u0,
                &shown.depth(span.u0 - u0, span.v - v0));
  shown.expected.image = std::as_const(shown.depth).view();
  shown.expected.u0 = u0;
  shown.expected.v0 = v0;
}

Prediction CameraPredictor::judge(std::size_t target, bool is_near) {
  const SeenTarget& shown = shown_[target];
  if (!shown.fault.empty()) return {.reason = shown.fault};
  Prediction prediction{.verdict = Verdict::out_of_view, .clearance = free_};
  if (shown.spans.empty()) return prediction;
  if (is_near) {
    tally_.count(images_, label_rule_, shown.spans, shown.expected, false, nullptr);
  } else {
    tally_.clear();
    tally_.inside = tally_.pixels[PixelState::clear] = shown.inside;
    tally_.is_expected = shown.expected.known();
  }
  tally_.covered = shown.covered;
  TargetMemory none;
  Judgement judgement = judgement_of(tally_, images_, targets_[target].thresholds, none);
  distrust(images_, judgement);
  prediction.verdict = judgement.verdict;
  prediction.hidden = judgement.occluded;
  prediction.reason = std::move(judgement.reason);
  if (!judgement.blame.empty()) prediction.by = std::move(judgement.blame.front().name);
  const PixelState blocked = tally_.is_expected ? PixelState::occluded : PixelState::unknown;
  if (is_near && clearance_ > 0)
    prediction.clearance =
        clearance_of_.measure(shown, images_.virtual_depth, tally_.pixels[blocked] > 0, clearance_);
  return prediction;
}

double CameraPredictor::motion_of(std::size_t body, const Sample& a, const Sample& b) const {
  const Eigen::AlignedBox3d& bounds = bounds_[body];
  const Eigen::Isometry3d& Ta = a.bodies[body].T_camera_body;
  const Eigen::Isometry3d& Tb = b.bodies[body].T_camera_body;
  double most = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const Eigen::Vector3d pa = Ta * corner, pb = Tb * corner;
    most = std::max(most, (pa - pb).norm());
    nearest = std::min({nearest, pa.z(), pb.z()});
  }
  return most * std::max(camera_.intrinsics.fx(), camera_.intrinsics.fy()) /
         std::max(nearest, DepthRenderer::near_plane);
}

}  // namespace penumbra::planning
