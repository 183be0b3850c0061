// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <numbers>
#include <variant>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/calibration/watch_solution-inl.hpp>

namespace penumbra {
namespace watching {

using calibration::Twist;

constexpr std::size_t period = 4;     // one of so many frames is compared, to save time
constexpr std::size_t samples = 80;   // pixels of the robot that are compared in it
constexpr int least_step = 8;         // pixels between them
constexpr double gate = 0.1;          // metres between measured and virtual depth
constexpr float through = 0.05F;      // metres behind the surface
constexpr double least_sigma = 5e-4;  // metres

constexpr double view_motion = 0.03;  // metres that a link moves in the camera until a new view
constexpr std::size_t view_frames = 8;
constexpr double same_view = 0.01;  // metres
constexpr std::size_t most_views = 256, least_views = 24;
constexpr std::size_t certain_views = 60;  // from so many on a motion without a bump is believed
constexpr std::size_t solve_period = 5;    // frames

constexpr double offset_prior = 0.01, scale_prior = 0.01, time_prior = 0.1;  // metres, 1, seconds

// Velocities are from poses so far apart, seconds: joint positions have noise, motion changes.
constexpr double least_between = 0.025, most_between = 0.5;
// Residuals are linear in steps so small: seconds, and metres as of pose_difference.
constexpr double time_step = 0.002, pose_step = 0.01;
constexpr double clear_sigmas = 6.0;  // of the time offset, that chance does not reach
constexpr double time_limit = 0.005;  // seconds: 5 mm of an arm at 1 m/s

constexpr std::array<std::size_t, 7> recent{16, 20, 24, 32,
                                            40, 52, 64};  // views after a possible bump
constexpr double by_chance =
    56.0;  // squared Mahalanobis distance of six that chance does not reach

/// The links' poses in the camera at a stamp.
struct Poses {
  std::int64_t stamp;  // nanoseconds
  std::vector<Eigen::Isometry3d> T_camera_link;
};

/// How a link moves in the camera: (rotation, translation) per second, and per second squared.
struct Velocity {
  Twist first = Twist::Zero(), second = Twist::Zero();
  [[nodiscard]] Twist at(double seconds) const { return first + seconds * second; }
  [[nodiscard]] Eigen::Isometry3d motion(double seconds) const {
    return calibration::motion(seconds * at(0.5 * seconds));
  }
};

/// The mean velocity from pose `a` to pose `b`.
Twist velocity_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double seconds) {
  const Eigen::Isometry3d moved = b * a.inverse();
  const Eigen::AngleAxisd angle(moved.linear());
  const Eigen::Vector3d turn = angle.angle() * angle.axis(), t = moved.translation();
  Twist twist;
  twist << turn, t - 0.5 * turn.cross(t);
  return twist / seconds;
}

// Squares by which views may tell against the frame of a bump, and frames within which it is known.
constexpr double unclear = 20.0;
constexpr std::size_t most_within = 30;

Estimate time_of(const Solution& solution) {
  return {solution.value[time_offset], std::sqrt(solution.covariance(time_offset, time_offset))};
}

bool is_beyond_chance(const Estimate& time) {
  return std::abs(time.value) > std::max(time_limit, clear_sigmas * time.sigma);
}

/// How improbable a motion is if there was none.
double distance(const Twist& motion, const PoseCovariance& covariance) {
  return dense::squared_sigmas(motion, covariance);
}

}  // namespace watching

using namespace watching;

struct CalibrationWatch::State {
  explicit State(const Camera& of) : camera(of.check()) {}

  struct Sample {
    std::size_t link;
    double value;
    Vector row;
  };

  void place(const FrameReport& report);
  void sample(const FrameReport& report);
  void sample_at(int u, int v, const FrameReport& report);
  void accumulate(const FrameReport& report);
  void close(View& view);
  void begin(View& view, std::size_t link, const FrameReport& report);
  [[nodiscard]] std::vector<const View*> sorted_views() const;
  void estimate();
  void set(const Solution& pose, const Solution& clocks);
  [[nodiscard]] bool is_moved(const Solution& solution) const;
  [[nodiscard]] bool settle(const Solution& all);
  void look_for_bump();
  void locate_bump(const std::vector<const View*>& sorted, const Vector& before,
                   const Vector& after);
  [[nodiscard]] bool is_beyond_limits(const Twist& motion) const;

  Camera camera;
  DriftLimits limits;
  int margin;
  Drift drift;
  Prior at_first, prior;
  std::size_t seen = 0, frames = 0;  // frames: those that are compared
  std::vector<Eigen::Isometry3d> T_camera_link;
  std::deque<Poses> past;            // the newest last
  std::vector<Velocity> velocities;  // of each link
  Vector at = Vector::Zero();        // pose and time offset with which frames are compared
  double time_reach = time_prior;    // seconds by which that may be wrong
  bool is_bumped = false;
  bool is_settled = false;  // the estimate agrees with it
  std::vector<Sample> found;
  std::vector<double> sizes;
  double sigma = 0.005;    // metres
  std::vector<View> open;  // by link
  std::deque<View> views;
  std::size_t places = 0;
};

/// Sets the links' poses, and their velocities by the frames before.
void CalibrationWatch::State::place(const FrameReport& report) {
  const Eigen::Isometry3d T_camera_root = report.T_root_camera->inverse();
  const std::size_t links = report.T_root_link.size();
  T_camera_link.resize(links);
  for (std::size_t i = 0; i < links; ++i) T_camera_link[i] = T_camera_root * report.T_root_link[i];
  velocities.assign(links, {});
  open.resize(links);
  if (!report.stamp) return;
  const auto seconds = [](std::int64_t from, std::int64_t to) {
    return 1e-9 * static_cast<double>(to - from);
  };
  if (!past.empty() && (past.back().T_camera_link.size() != links ||
                        !(seconds(past.back().stamp, *report.stamp) > 0.0)))
    past.clear();
  auto last = past.rbegin();
  while (last != past.rend() && seconds(last->stamp, *report.stamp) < least_between) ++last;
  const double step = last == past.rend() ? most_between : seconds(last->stamp, *report.stamp);
  if (step < most_between) {
    const auto before = std::next(last);
    const double step_before =
        before == past.rend() ? most_between : seconds(before->stamp, last->stamp);
    for (std::size_t i = 0; i < links; ++i) {
      Velocity& velocity = velocities[i];
      velocity.first = velocity_between(last->T_camera_link[i], T_camera_link[i], step);
      if (!(step_before < most_between)) continue;
      velocity.second = 2.0 / (step + step_before) *
                        (velocity.first - velocity_between(before->T_camera_link[i],
                                                           last->T_camera_link[i], step_before));
      velocity.first += 0.5 * step * velocity.second;
    }
  }
  if (!past.empty() && seconds(past.back().stamp, *report.stamp) < least_between) return;
  past.push_back({*report.stamp, T_camera_link});
  if (past.size() > 3) past.pop_front();
}

void CalibrationWatch::State::sample_at(int u, int v, const FrameReport& report) {
  const VirtualDepthView& robot = report.virtual_depth;
  if (!calibration::is_inside(robot, u, v, margin)) return;
  const auto link = static_cast<std::size_t>(robot.links(u, v) - 1);
  if (link >= report.T_root_link.size()) return;  // attached: its pose is not calibrated
  const auto measured_at = [&](int x, int y) {
    return std::visit([&](const auto& depth) { return metres_of(depth(x, y)); }, report.depth);
  };
  if (const float here = measured_at(u, v); here > 0.0F)
    drift.seen_through += ((here > robot.depth(u, v) + through) - drift.seen_through) / 5000.0;
  const auto ray_of = [&](int x, int y) -> std::optional<Eigen::Vector3d> {
    const auto point = camera.distortion.undistort(camera.intrinsics.ray(x, y).head<2>());
    if (!point) return std::nullopt;
    return point->homogeneous();
  };
  auto surface = calibration::surface_at(robot, u, v, ray_of);
  if (!surface) return;
  // Where that piece of the surface is when the image was taken, and what is measured there.
  const double time = at[time_offset];
  const Eigen::Isometry3d motion =
      calibration::motion(at.head<6>()).inverse() * velocities[link].motion(time);
  surface->point = motion * surface->point;
  surface->normal = motion.linear() * surface->normal;
  const Eigen::Vector3d& p = surface->point;
  const Eigen::Vector2d pixel =
      camera.intrinsics.project(camera.distortion.distort(p.head<2>() / p.z()).homogeneous());
  const int x = static_cast<int>(std::lround(pixel.x())),
            y = static_cast<int>(std::lround(pixel.y()));
  if (!(p.z() > 0.0) || x < 0 || x >= robot.depth.width || y < 0 || y >= robot.depth.height) return;
  const double measured = measured_at(x, y);
  const auto ray = ray_of(x, y);
  if (!(measured > 0.0) || !ray) return;
  const auto along = surface->along(*ray);
  if (!along) return;
  const Twist gradient = surface->gradient();
  const double by_time = gradient.dot(velocities[link].at(time));
  const double value = measured * *along - surface->normal.dot(p);
  if (!(std::abs(value) < (gate + time_reach * std::abs(by_time / *along)) * std::abs(*along)))
    return;
  Sample& sample = found.emplace_back();
  sample.link = link;
  sample.value = value;
  sample.row.head<6>() = -gradient;
  sample.row[depth_offset] = -*along;
  sample.row[depth_scale] = -measured * *along;
  sample.row[time_offset] = by_time;
}

void CalibrationWatch::State::sample(const FrameReport& report) {
  found.clear();
  const auto& z = report.virtual_depth.depth;
  const int step =
      std::max(least_step, static_cast<int>(std::sqrt(report.pixels.robot.value_or(0) / samples)));
  // Other pixels in each frame.
  const int first_u = margin + static_cast<int>(7 * frames % static_cast<std::size_t>(step));
  const int first_v = margin + static_cast<int>(3 * frames % static_cast<std::size_t>(step));
  for (int v = first_v; v + margin < z.height; v += step)
    for (int u = first_u; u + margin < z.width; u += step)
      if (z(u, v) > 0.0F) sample_at(u, v, report);
}

void CalibrationWatch::State::close(View& view) {
  if (view.count > 0) views.push_back(view);
  if (views.size() > most_views) views.pop_front();
  view.count = 0;
}

void CalibrationWatch::State::begin(View& view, std::size_t link, const FrameReport& report) {
  view = {};
  view.link = link;
  view.first_frame = frames;
  view.index = report.index;
  view.stamp = report.stamp;
  view.T_camera_link = T_camera_link[link];
  const auto same = std::ranges::find_if(views, [&](const View& other) {
    return other.link == link &&
           pose_difference(other.T_camera_link, view.T_camera_link) < same_view;
  });
  view.place = same == views.end() ? places++ : same->place;
}

/// Returns the views in the order of their first frames, open ones among them.
std::vector<const View*> CalibrationWatch::State::sorted_views() const {
  std::vector<const View*> all;
  for (const View& view : views) all.push_back(&view);
  for (const View& view : open)
    if (view.count > 0) all.push_back(&view);
  std::ranges::sort(all, {}, &View::first_frame);
  return all;
}

void CalibrationWatch::State::accumulate(const FrameReport& report) {
  sizes.clear();
  for (const Sample& sample : found) sizes.push_back(std::abs(sample.value));
  if (sizes.empty()) return;
  const double now = std::max(least_sigma, detail::robust_sigma(sizes));
  sigma += 0.05 * (now - sigma);
  const double scale = std::max(sigma, now);  // of a camera that was bumped, at once larger
  for (std::size_t link = 0; link < open.size(); ++link) {
    View& view = open[link];
    if (view.count == 0 || (frames - view.first_frame < view_frames &&
                            pose_difference(view.T_camera_link, T_camera_link[link]) < view_motion))
      continue;
    close(view);
  }
  for (const Sample& sample : found) {
    const double inlier = detail::tukey_weight(
        sample.value, detail::tukey_width * scale + time_reach * std::abs(sample.row[time_offset]));
    if (inlier == 0.0) continue;
    View& view = open[sample.link];
    if (view.count == 0) begin(view, sample.link, report);
    const double weight = inlier / (scale * scale);
    view.information += weight * sample.row * sample.row.transpose();
    view.gradient += weight * (sample.value - sample.row.dot(at)) * sample.row;
    view.last_index = report.index;
    ++view.count;
  }
}

/// Compares the last views with those long before, and forgets all but them if the camera has moved
/// between.
void CalibrationWatch::State::look_for_bump() {
  const std::vector<const View*> all = sorted_views();
  for (const std::size_t last : recent) {
    if (all.size() < last + least_views) return;
    const auto from = all.end() - static_cast<std::ptrdiff_t>(last);
    const std::size_t start = (*from)->first_frame;
    const auto is_later = [&](const View* view) { return view->first_frame >= start; };
    const auto first = std::ranges::find_if(all, is_later);
    const auto earlier = solve({all.begin(), first}, prior);
    if (!earlier) return;
    Prior sensor;  // its own errors stay
    sensor.value.tail<3>() = earlier->value.tail<3>();
    sensor.information.bottomRightCorner<3, 3>() =
        earlier->covariance.bottomRightCorner<3, 3>().inverse();
    const auto later = solve({first, all.end()}, sensor);
    if (!later) continue;
    const Twist moved = (later->value - earlier->value).head<6>();
    if (!is_beyond_limits(moved) ||
        distance(moved, (later->covariance + earlier->covariance).topLeftCorner<6, 6>()) <
            by_chance)
      continue;
    is_bumped = true;
    locate_bump(all, earlier->value, later->value);
    prior = sensor;
    std::erase_if(views, [&](const View& view) { return view.first_frame < start; });
    for (View& view : open)
      if (view.first_frame < start) view.count = 0;
    return;
  }
}

/// Finds the frames at which the camera may have moved: where views change from one solution to the
/// other.
void CalibrationWatch::State::locate_bump(const std::vector<const View*>& sorted,
                                          const Vector& before, const Vector& after) {
  std::vector<double> squares{0.0};  // with the first so many views before
  for (const View* view : sorted)
    squares.push_back(squares.back() + view->rise(before) - view->rise(after));
  const auto best = std::ranges::min_element(squares);
  const auto may_be = [&](double square) { return square < *best + unclear; };
  const auto first = std::ranges::find_if(squares, may_be) - squares.begin();
  const auto last = std::find_if(squares.rbegin(), squares.rend(), may_be).base() - squares.begin();
  const auto nth = [&](std::ptrdiff_t i) { return sorted[static_cast<std::size_t>(i)]; };
  const std::size_t from = nth(std::max<std::ptrdiff_t>(first - 1, 0))->index;
  std::size_t to = from;
  for (std::ptrdiff_t i = 0; i < std::min<std::ptrdiff_t>(last, std::ssize(sorted)); ++i)
    to = std::max(to, nth(i)->last_index);
  drift.bumped_at.reset();
  drift.bumped_at_stamp.reset();
  drift.bumped_within = (to - from + 1) / 2;
  if (drift.bumped_within > most_within) return;
  drift.bumped_at = from + drift.bumped_within;
  drift.bumped_at_stamp = nth(std::min(best - squares.begin(), std::ssize(sorted) - 1))->stamp;
}

bool CalibrationWatch::State::is_beyond_limits(const Twist& motion) const {
  return motion.tail<3>().norm() > limits.position || motion.head<3>().norm() > limits.rotation;
}

void CalibrationWatch::State::set(const Solution& pose, const Solution& clocks) {
  drift.T_calibrated_camera = calibration::motion(pose.value.head<6>());
  drift.covariance = pose.covariance.topLeftCorner<6, 6>();
  drift.time_offset = time_of(clocks);
}

bool CalibrationWatch::State::is_moved(const Solution& solution) const {
  const Twist twist = solution.value.head<6>();
  return is_beyond_limits(twist) &&
         distance(twist, solution.covariance.topLeftCorner<6, 6>()) > by_chance;
}

void CalibrationWatch::State::estimate() {
  if (is_settled && !drift.clocks_differ) look_for_bump();
  const std::vector<const View*> all = sorted_views();
  if (all.size() < least_views) return;
  const auto both = solve(all, prior);
  if (!both || !settle(*both)) return;
  drift.is_known = true;
  set(*both, *both);
  const bool is_off = is_moved(*both) && (is_bumped || all.size() >= certain_views);
  const bool is_late = is_beyond_chance(drift.time_offset);
  const bool is_unclear = is_off && is_late && both->is_both();
  const bool is_amount_known =
      drift.position() > drift.position_error() || drift.rotation() > drift.rotation_error();
  drift.has_moved = is_off && both->blames_pose() && !is_unclear && (is_amount_known || is_bumped);
  drift.clocks_differ = is_late && !both->is_both() && both->blames_clocks();
  drift.camera_or_clocks = is_unclear;
  if (is_off || is_late || !both->is_either()) return;
  // Too much alike: each alone.
  const auto pose = solve(all, prior.with_zero(time_offset, 1));
  const auto clocks = solve(all, prior.with_zero(0, 6));
  if (!pose || !clocks || !is_moved(*pose)) return;
  drift.camera_or_clocks = is_beyond_chance(time_of(*clocks));
  if (drift.camera_or_clocks) set(*pose, *clocks);
}

/// Whether the estimate is where frames were compared; else begins again there, because residuals
/// are linear in small steps only, and large ones are left out.
bool CalibrationWatch::State::settle(const Solution& all) {
  const Vector by = all.value - at;
  time_reach = std::sqrt(all.covariance(time_offset, time_offset));
  const bool is_late = all.blames_clocks() &&
                       std::abs(by[time_offset]) > std::max(time_step, clear_sigmas * time_reach);
  const bool is_off = all.blames_pose() &&
                      pose_difference(calibration::motion(at.head<6>()),
                                      calibration::motion(all.value.head<6>())) > pose_step &&
                      distance(by.head<6>(), all.covariance.topLeftCorner<6, 6>()) > by_chance;
  is_settled = !is_late && !is_off;
  if (is_settled) return true;
  if (is_off) at.head<6>() = all.value.head<6>();
  if (is_late) {
    at[time_offset] = all.value[time_offset];
    time_reach += std::abs(by[time_offset]);
  }
  views.clear();
  for (View& view : open) view.count = 0;
  prior = at_first;
  return false;
}

void DriftLimits::check() const {
  if (position > 0.0 && rotation > 0.0) return;
  throw InputError("drift limits are " + std::to_string(1e3 * position) + " mm and " +
                   std::to_string(rotation * 180.0 / std::numbers::pi) +
                   " degrees; expected positive numbers");
}

CalibrationWatch::CalibrationWatch(const Camera& camera, const DriftLimits& limits, bool is_camera)
    : state_(std::make_unique<State>(camera)) {
  state_->drift.is_camera = is_camera;
  limits.check();
  state_->limits = limits;
  state_->margin = std::max(2, camera.intrinsics.width() / 200);
  Vector sigmas = Vector::Constant(1.0);
  sigmas.tail<3>() << offset_prior, scale_prior, time_prior;
  state_->prior.information.diagonal() = sigmas.array().square().inverse();
  state_->prior.information.topLeftCorner<6, 6>().setZero();
  state_->at_first = state_->prior;
}

CalibrationWatch::~CalibrationWatch() = default;
CalibrationWatch::CalibrationWatch(CalibrationWatch&&) noexcept = default;
CalibrationWatch& CalibrationWatch::operator=(CalibrationWatch&&) noexcept = default;

void CalibrationWatch::add(const FrameReport& report) {
  if (report.status != FrameStatus::ok || report.virtual_depth.depth.empty() ||
      is_empty(report.depth))
    return;
  State& state = *state_;
  state.place(report);
  const bool is_compared = compares_next();
  ++state.seen;
  if (!is_compared) return;
  state.sample(report);
  state.accumulate(report);
  if (++state.frames % solve_period == 0) state.estimate();
}

bool CalibrationWatch::compares_next() const { return state_->seen % period == 0; }

const Drift& CalibrationWatch::drift() const { return state_->drift; }

}  // namespace penumbra
