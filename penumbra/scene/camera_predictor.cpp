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
#include <penumbra/robot/drawn_links-inl.hpp>
#include <penumbra/scene/camera_predictor-inl.hpp>
#include <penumbra/targets/extent_tally-inl.hpp>

namespace penumbra::scene {
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

/// Nothing is measured, so that nothing can be missed or passed.
TargetThresholds without_measurements(TargetThresholds thresholds) {
  thresholds.past_limit = 1.0;
  thresholds.min_measured = 0.0;
  return thresholds;
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

PixelRectangle rectangle_of(std::span<const RowSpan> spans) {
  const SpanBox box = box_of_spans(spans);
  return {box.u0, box.v0, box.u1 + 1, box.v1 + 1};
}

PixelRectangle grown(const PixelRectangle& box, int by, const Intrinsics& image) {
  return overlap({box.u0 - by, box.v0 - by, box.u1 + by, box.v1 + by},
                 {0, 0, image.width(), image.height()});
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
  target.thresholds = without_measurements(target.thresholds);
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
      anchored_(targets),
      rectification_(rectification_of(camera.camera.check())),
      camera_(rectified(camera.camera, rectification_)),
      clearance_(clearance),
      rule_(within_range(camera.rule)),
      label_rule_(rule_),
      poses_(robot, camera.parent, camera.T_parent_camera, {}),
      renderer_(make_depth_renderer(Backend::cpu, camera_.intrinsics,
                                    bodies_with(robot, start.attached))),
      near_plane_(camera_.intrinsics, bodies_with(robot, start.attached)),
      always_unknown_(why_parts_lack(robot, start.attached)),
      objects_(camera_.intrinsics, Backend::cpu, {}, nullptr, camera_),
      views_(robot, camera_, objects_, rule_, nullptr),
      judge_([&] {
        if (rectification_) uncovered_.emplace(rectification_->pinhole_to_raw());
        return TargetJudge(camera_, rule_, robot.links().size() + max_attached,
                           uncovered_ ? uncovered_->mask() : ImageView<const std::uint8_t>{});
      }()),
      seen_pixels_(uncovered_ ? uncovered_->mask() : ImageView<const std::uint8_t>{}),
      spans_(camera_.intrinsics.width(), camera_.intrinsics.height()),
      labels_(camera_.intrinsics.width(), camera_.intrinsics.height()) {
  for (const AnchoredTarget& target : targets) targets_.push_back(target.start.target);
  for (const Body& body : bodies_with(robot, start.attached)) {
    Part& part = parts_.emplace_back(Part{std::string(body.name), {}});
    for (const PreparedMesh& mesh : body.meshes) part.bounds.extend(mesh.bounds);
  }
  pose_.uncertain_links = start.uncertain_links;
  pose_.uncertain_reason = start.uncertain_reason;
  std::ranges::copy_if(start.attached, std::back_inserter(pose_.attached), is_drawn);
}

Sample CameraPredictor::at(double time, std::span<const double> positions) {
  pose_.positions.assign(positions.begin(), positions.end());
  const PoseResult& poses = poses_.place(pose_, std::nullopt, FrameStatus::ok, {});
  Sample sample;
  sample.time = time;
  sample.targets.resize(targets_.size());
  // One on a link of unknown pose is not placed.
  const bool is_known = poses.known() && poses.attached.size() == pose_.attached.size();
  if (is_known) place_bodies(poses, sample);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const auto is_carried = [&](const AttachedBody& body) { return body.name == targets_[i].name; };
    if (!is_known)
      sample.predictions.push_back({.reason = poses.message});
    else if (std::ranges::any_of(pose_.attached, is_carried))
      sample.predictions.push_back({.verdict = Verdict::held, .clearance = double(clearance_)});
    else
      sample.predictions.push_back(judge(i, poses, sample));
  }
  return sample;
}

void CameraPredictor::place_bodies(const PoseResult& poses, Sample& sample) {
  T_camera_body_ = poses.T_camera_link;
  for (const PlacedBody& body : poses.attached) T_camera_body_.push_back(body.T_camera_body);
  for (std::size_t i = 0; i < parts_.size(); ++i)
    sample.bodies.push_back(
        {T_camera_body_[i],
         parts_[i].bounds.isEmpty() || !T_camera_body_[i].matrix().allFinite()
             ? PixelRectangle{}
             : pixels_of(parts_[i].bounds, T_camera_body_[i], camera_.intrinsics)});
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

/// Returns the target's view; null if it is outside of the camera's.
std::optional<CameraPredictor::Shown> CameraPredictor::show(std::size_t target,
                                                            const PoseResult& poses, double time) {
  const std::string& fault = anchored_[target].start.target.fault;
  if (!fault.empty()) throw InputError(fault);
  move(target, time);
  const Eigen::Isometry3d T_camera_root = poses.T_root_camera.inverse();
  if (const auto placement = placement_of(targets_[target].shape)) {
    const Eigen::Isometry3d T_root_frame = pose_of(placement->frame, poses, robot_);
    const double depth = (T_camera_root * (T_root_frame * placement->pose.translation())).z();
    if (depth < camera_.range.near || depth > camera_.range.far) return std::nullopt;
    const auto view = views_.view(targets_[target], {}, poses);
    if (!view) return std::nullopt;
    return Shown{*view, depth};
  }
  Shown shown;
  shown.view.thresholds = targets_[target].thresholds;
  shown.view.depth_margin = targets_[target].depth_margin;
  if (!anchored_[target].outline.empty()) {
    PixelPolygon polygon;
    for (const Eigen::Vector3d& corner : outline_) {
      const Eigen::Vector3d p = T_camera_root * corner;
      if (p.z() < DepthRenderer::near_plane) continue;
      polygon.corners.push_back(camera_.intrinsics.project(p));
      shown.depth += p.z() / static_cast<double>(outline_.size());
    }
    if (polygon.corners.empty()) return std::nullopt;
    if (polygon.corners.size() < outline_.size())
      throw InputError("it reaches the plane of the camera's lens");
    if (shown.depth < camera_.range.near || shown.depth > camera_.range.far) return std::nullopt;
    shown.view.region = std::move(polygon);
    shown.view.expected_depth = shown.depth;
    return shown;
  }
  if (rectification_ || !poses.T_root_camera.isApprox(anchored_[target].T_root_camera))
    throw InputError(
        "its pixels cannot be followed in another camera, one that moves, or one whose lens bends: "
        "give a box or polygon and its expected_depth");
  const auto view = views_.view(targets_[target], {}, poses);
  if (!view) return std::nullopt;
  shown.view = *view;
  shown.view.extent = Extent::amodal;
  shown.depth = view->expected_depth.value_or(std::numeric_limits<double>::infinity());
  return shown;
}

Prediction CameraPredictor::judge(std::size_t target, const PoseResult& poses, Sample& sample) {
  Prediction prediction{.verdict = Verdict::out_of_view, .clearance = double(clearance_)};
  try {
    auto shown = show(target, poses, sample.time);
    if (!shown) return prediction;
    shown->view.wants_point = false;
    spans_.fill(shown->view.region);
    spans_.keep(seen_pixels_);
    if (spans_.spans().empty()) return prediction;
    const PixelRectangle region = rectangle_of(spans_.spans());
    const PixelRectangle window = grown(region, clearance_, camera_.intrinsics);
    sample.targets[target] = region;
    const bool is_near = std::ranges::any_of(
        sample.bodies, [&](const SeenBody& body) { return !overlap(body.pixels, window).empty(); });
    draw(is_near, window, region);
    LabelledImages images;
    images.labels.labels = labels_.view();
    images.virtual_depth = drawn_;
    judge_.begin(images);
    const Judgement judgement = judge_.judge(shown->view);
    prediction.verdict = judgement.verdict;
    prediction.hidden = judgement.occluded;
    prediction.reason = judgement.reason;
    if (!judgement.blame.empty()) prediction.by = parts_[judgement.blame.front().link].name;
    if (is_near) prediction.clearance = clearance(*shown, window);
  } catch (const InputError& error) {
    return {.reason = error.what()};
  }
  if (!unknown_reason_.empty() &&
      (prediction.verdict == Verdict::visible || prediction.verdict == Verdict::partial)) {
    prediction.verdict = Verdict::unknown;
    prediction.reason = unknown_reason_;
  }
  return prediction;
}

/// Draws the robot in a window, and labels it in the region: nothing is measured, so that the judge
/// compares the robot's depth with the target's.
void CameraPredictor::draw(bool is_near, const PixelRectangle& window,
                           const PixelRectangle& region) {
  if (is_near || drawn_.depth.empty()) drawn_ = renderer_->render(T_camera_body_, window);
  for (int v = region.v0; v < region.v1; ++v) {
    const float* const depth = drawn_.depth.row(v);
    for (int u = region.u0; u < region.u1; ++u)
      labels_(u, v) =
          static_cast<std::uint8_t>(is_near && depth[u] > 0.0F ? Label::unknown : Label::clear);
  }
}

double CameraPredictor::clearance(const Shown& shown, const PixelRectangle& window) {
  mark_blocked(shown, window);
  const auto is_blocked = [&](const RowSpan& span) {
    const auto* row = &blocked_[index(window, span.u0, span.v)];
    return std::find(row, row + (span.u1 - span.u0), 1) != row + (span.u1 - span.u0);
  };
  return std::ranges::any_of(spans_.spans(), is_blocked) ? -hidden_depth(window)
                                                         : free_distance(window);
}

/// Marks the pixels of the robot that are before the target; outside of the target's region, before
/// its middle.
void CameraPredictor::mark_blocked(const Shown& shown, const PixelRectangle& window) {
  const LimitRule rule(label_rule_, shown.view.depth_margin);
  const bool is_known = std::isfinite(shown.depth);
  const float near = is_known ? rule.at(static_cast<float>(shown.depth)).near
                              : std::numeric_limits<float>::infinity();
  blocked_.resize(static_cast<std::size_t>(window.width()) *
                  static_cast<std::size_t>(window.height()));
  for (int v = window.v0; v < window.v1; ++v) {
    const float* const depth = drawn_.depth.row(v) + window.u0;
    std::uint8_t* const row = &blocked_[index(window, window.u0, v)];
    const int width = window.width();
    for (int u = 0; u < width; ++u)  // without branches, to vectorise
      row[u] = static_cast<std::uint8_t>((depth[u] > 0.0F) & (depth[u] < near));
  }
  const auto* const rendered = std::get_if<RenderedRegion>(&shown.view.region);
  if (rendered == nullptr) return;
  for (const RowSpan& span : spans_.spans()) {
    const float* const depth = drawn_.depth.row(span.v);
    const float* const expected = rendered->depth.view.row(span.v);
    for (int u = span.u0; u < span.u1; ++u)
      blocked_[index(window, u, span.v)] =
          depth[u] > 0.0F && depth[u] < rule.at(expected[u]).near ? 1 : 0;
  }
}

/// Returns the distance from the target's region to the nearest blocked pixel; 0 where they touch.
double CameraPredictor::free_distance(const PixelRectangle& window) const {
  const int most = clearance_ + 1;
  int best = most * most;  // squared
  for (int v = window.v0; v < window.v1; ++v) {
    const std::uint8_t* const row = &blocked_[index(window, window.u0, v)];
    const std::uint8_t* const end = row + window.width();
    for (const std::uint8_t* run = std::find(row, end, 1); run != end;) {
      const std::uint8_t* const run_end = std::find(run, end, 0);
      const int u0 = window.u0 + static_cast<int>(run - row);
      const int u1 = window.u0 + static_cast<int>(run_end - row);
      for (const RowSpan& span : spans_.spans()) {
        const int dv = span.v - v;
        if (dv * dv >= best) continue;
        const int du = std::max({0, u0 - (span.u1 - 1), span.u0 - (u1 - 1)});
        best = std::min(best, du * du + dv * dv);
      }
      run = std::find(run_end, end, 1);
    }
  }
  return std::min(std::sqrt(best) - 1.0, static_cast<double>(clearance_));
}

/// Returns how far the innermost blocked pixel of the target's region is from one that is free: the
/// exact distance transform, rows first (Felzenszwalb and Huttenlocher, "Distance transforms of
/// sampled functions"), where it can still grow.
double CameraPredictor::hidden_depth(const PixelRectangle& window) {
  const int width = window.width();
  const auto most = static_cast<std::int16_t>(clearance_);
  columns_.resize(blocked_.size());
  const auto row_of = [&](int v) { return &columns_[index(window, window.u0, v)]; };
  for (int v = window.v0; v < window.v1; ++v) {
    const std::uint8_t* const blocked = &blocked_[index(window, window.u0, v)];
    std::int16_t* const row = row_of(v);
    if (v == window.v0)
      for (int u = 0; u < width; ++u) row[u] = static_cast<std::int16_t>(most * blocked[u]);
    else
      for (int u = 0; u < width; ++u)  // without branches, to vectorise
        row[u] = static_cast<std::int16_t>(
            std::min<std::int16_t>(most, static_cast<std::int16_t>(row[u - width] + 1)) *
            blocked[u]);
  }
  for (int v = window.v1 - 2; v >= window.v0; --v) {
    std::int16_t* const row = row_of(v);
    const std::int16_t* const below = row_of(v + 1);
    for (int u = 0; u < width; ++u)
      row[u] = std::min(row[u], static_cast<std::int16_t>(below[u] + 1));
  }
  int deepest = 0;  // squared
  for (const RowSpan& span : spans_.spans()) {
    const std::int16_t* const row = row_of(span.v);
    for (int u = span.u0 - window.u0; u < span.u1 - window.u0;) {
      int nearest = row[u] * row[u];
      for (int du = 1; du * du < nearest && nearest > deepest; ++du) {
        if (u - du >= 0) nearest = std::min(nearest, du * du + row[u - du] * row[u - du]);
        if (u + du < width) nearest = std::min(nearest, du * du + row[u + du] * row[u + du]);
      }
      deepest = std::max(deepest, nearest);
      // From one pixel to the next the distance grows by 1 at most.
      u += 1 + static_cast<int>(std::sqrt(deepest) - std::sqrt(nearest));
    }
  }
  return std::sqrt(deepest);
}

double CameraPredictor::motion_of(std::size_t body, const Sample& a, const Sample& b) const {
  const Eigen::AlignedBox3d& bounds = parts_[body].bounds;
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

}  // namespace penumbra::scene
