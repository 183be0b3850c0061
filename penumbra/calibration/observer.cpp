// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::calibration {
namespace {

constexpr int columns = 320;              // residuals are taken from about so many columns
constexpr float before_edge = 0.05f;      // metres nearer than the robot's outline that are robot
constexpr float behind_edge = 0.02f;      // the same, farther
constexpr float background = 0.10f;       // metres behind the outline, at least
constexpr int run = 4, least_of_run = 3;  // pixels on each side of an edge that must agree
constexpr int most_missing = 4;           // pixels without measurement at an edge
constexpr int mask_reach = 40;            // pixels
constexpr double agreeing_depth = 0.02;   // metres

/// As std::lround of a pixel's coordinate, without a call.
int nearest(double coordinate) {
  constexpr int positive = 1 << 16;
  return static_cast<int>(coordinate + (positive + 0.5)) - positive;
}

}  // namespace

/// A frame with its robot rendered at a state.
struct Observer::View {
  const KeptFrame& frame;
  std::uint32_t number;
  const State& state;
  VirtualDepthView robot;
  std::vector<std::vector<Twist>> link_twists;
  int shift_x = static_cast<int>(std::lround(state.depth_shift.x()));
  int shift_y = static_cast<int>(std::lround(state.depth_shift.y()));

  [[nodiscard]] bool is_inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < robot.depth.width && v < robot.depth.height;
  }
  /// The measured depth at a pixel of the rendered image; 0: none. It lies at the pixel + rest().
  [[nodiscard]] float measured(int u, int v) const {
    const int x = u - shift_x, y = v - shift_y;
    if (!is_inside(x, y)) return 0.0f;
    const float z = frame.depth(x, y);
    return z > 0.0f ? state.corrected(z) : 0.0f;
  }
  [[nodiscard]] Eigen::Vector2d rest() const {
    return state.depth_shift - state.depth_shift.array().round().matrix();
  }
};

Observer::Observer(const Model& model, const Intrinsics& camera, const Unknowns& unknowns)
    : model_(model),
      nominal_(camera),
      camera_(camera),
      unknowns_(unknowns),
      stride_(std::max(1, (camera.width() + columns / 2) / columns)),
      margin_(std::max(2, camera.width() / 200)),
      renderer_(make_depth_renderer(Backend::cpu, camera, bodies_of(model.robot()))) {}

VirtualDepthView Observer::render(const KeptFrame& frame, const State& state) {
  const Intrinsics scaled(nominal_.width(), nominal_.height(),
                          nominal_.fx() * (1.0 + state.focal.x()),
                          nominal_.fy() * (1.0 + state.focal.y()), nominal_.cx(), nominal_.cy());
  if (scaled != camera_) {
    camera_ = scaled;
    renderer_ = make_depth_renderer(Backend::cpu, camera_, bodies_of(model_.robot()));
  }
  return renderer_->render(model_.T_camera_link(frame, state));
}

void Observer::observe(const KeptFrame& frame, std::size_t number, const State& state,
                       const Reach& reach, Residuals& out) {
  const View view{.frame = frame,
                  .number = static_cast<std::uint32_t>(number),
                  .state = state,
                  .robot = render(frame, state),
                  .link_twists = model_.link_twists(frame, state, unknowns_)};
  if (!frame.depth.empty()) add_surface(view, reach, out);
  add_outlines(view, reach, out);
}

/// `gradient` is the residual's derivative by a motion of its link in the camera's frame. The
/// camera moves by the opposite. `by_focal` is that by the focal lengths' relative change; a lens
/// changes them by the square of the distance from the axis, here to first order.
void Observer::add_row(const View& view, const Residual& residual, const Twist& gradient,
                       const Eigen::Vector2d& by_focal, const Eigen::Vector3d& ray,
                       Residuals& out) const {
  out.list.push_back(residual);
  out.rows.resize(out.rows.size() + static_cast<std::size_t>(unknowns_.size()), 0.0);
  double* const row = out.rows.data() + out.rows.size() - unknowns_.size();
  for (int i = 0; i < 6; ++i) row[i] = -gradient[i];
  const Eigen::Vector2d by_change = by_focal.array() / (1.0 + view.state.focal.array());
  if (unknowns_.focal_count == 1) row[unknowns_.focal()] = by_change.sum();
  if (unknowns_.focal_count == 2) Eigen::Map<Eigen::Vector2d>(row + unknowns_.focal()) = by_change;
  for (int i = unknowns_.joints(); i < unknowns_.size(); ++i)
    row[i] = gradient.dot(
        view.link_twists[static_cast<std::size_t>(i - unknowns_.joints())][residual.link]);
  const double by_lens = ray.head<2>().squaredNorm() * by_focal.sum();
  out.list.back().value += by_lens * view.state.lens;
  if (unknowns_.has_lens) row[unknowns_.lens()] = by_lens;
}

void Observer::add_surface(const View& view, const Reach& reach, Residuals& out) const {
  const auto& z = view.robot.depth;
  for (int v = margin_; v + margin_ < z.height; v += stride_)
    for (int u = margin_; u + margin_ < z.width; u += stride_) {
      if (!is_inside(view.robot, u, v, margin_)) continue;
      const float expected = z(u, v), measured = view.measured(u, v);
      if (!(measured > 0.0f) || std::abs(measured - expected) > reach.depth) continue;
      const auto surface =
          surface_at(view.robot, u, v, [&](int x, int y) { return camera_.ray(x, y); });
      const Eigen::Vector3d ray = camera_.ray(u, v);
      const auto along = surface ? surface->along(ray) : std::nullopt;
      if (!along) continue;
      const Eigen::Vector3d& normal = surface->normal;
      const Eigen::Vector2d sideways(measured / camera_.fx() * normal.x(),
                                     measured / camera_.fy() * normal.y());
      add_row(view,
              {.kind = Kind::surface,
               .link = static_cast<std::uint16_t>(view.robot.links(u, v) - 1),
               .frame = view.number,
               .value = (measured - expected) * *along + view.rest().dot(sideways)},
              surface->gradient(), -measured * normal.head<2>().cwiseProduct(ray.head<2>()), ray,
              out);
      double* const row = out.rows.data() + out.rows.size() - unknowns_.size();
      row[Unknowns::depth_offset] = -*along;
      row[Unknowns::depth_scale] = -measured * *along;
      if (unknowns_.has_shift) Eigen::Map<Eigen::Vector2d>(row + Unknowns::shift) = sideways;
    }
}

void Observer::add_outlines(const View& view, const Reach& reach, Residuals& out) const {
  const auto& z = view.robot.depth;
  constexpr int around = 3;  // pixels of the window that gives the outline's direction
  const auto robot = [&](int u, int v) { return z(u, v) > 0.0f; };
  std::vector<int> on_normal;

  const TileMask& touched = *view.robot.touched;
  for (int v = around; v + around < z.height; ++v)
    for (int u = around; u + around < z.width; ++u) {
      if (!touched.holds(u, v)) {
        u |= touched.tile_width - 1;  // the tile's last pixel
        continue;
      }
      if (!robot(u, v) ||
          (robot(u - 1, v) && robot(u + 1, v) && robot(u, v - 1) && robot(u, v + 1)) ||
          (u + v) % stride_ != 0)
        continue;
      Eigen::Vector2d inwards = Eigen::Vector2d::Zero();
      for (int dv = -around; dv <= around; ++dv)
        for (int du = -around; du <= around; ++du)
          if (robot(u + du, v + dv)) inwards += Eigen::Vector2d(du, dv);
      if (inwards.norm() < around * around) continue;  // a tip, or a thin part
      const Eigen::Vector2d normal = -inwards.normalized();
      const float edge = z(u, v);

      // What is on the normal at each step: 1 robot's depth or mask, 0 none, -1 not measured or
      // something else; nothing is looked at past another part of the robot.
      const auto step_of = [&](const auto& sample, int radius) -> std::optional<double> {
        constexpr int not_sampled = 2;
        const int first = -radius - run;
        on_normal.assign(2 * static_cast<std::size_t>(radius + run) + most_missing + 1,
                         not_sampled);
        const auto at_step = [&](int step) {
          int& at = on_normal[static_cast<std::size_t>(step - first)];
          if (at == not_sampled) at = sample(step);
          return at;
        };
        std::optional<double> best;  // nearest to 0, of two as near the one inside
        const auto try_after = [&](int last) {
          if (at_step(last) != 1) return;
          int next = last + 1;
          while (next - last <= most_missing && at_step(next) < 0) ++next;
          int robots = 0, others = 0;  // with what is before and behind the step
          for (int i = 0; i < run; ++i) {
            robots += at_step(last - i);
            others += at_step(next + i) == 0;
          }
          const bool is_step = robots >= least_of_run && others >= least_of_run;
          const double at = 0.5 * (last + next) - 0.5;
          if (is_step && (!best || std::abs(at) < std::abs(*best) || at == -std::abs(*best)))
            best = at;
        };
        // A step lies from `last` to half of most_missing behind it.
        for (int k = 0; k <= radius && !(best && k > std::abs(*best) + 0.5 * most_missing); ++k)
          for (const int last : {-k, k}) try_after(last);
        return best;
      };
      const auto pixel = [&](int step) {
        return std::pair{nearest(u + step * normal.x()), nearest(v + step * normal.y())};
      };
      const auto is_free = [&](int step) {
        const auto [x, y] = pixel(step);
        return view.is_inside(x, y) && (step <= 1 || !robot(x, y));
      };
      const auto depth_at = [&](int step) {
        const auto [x, y] = pixel(step);
        if (!is_free(step)) return -1;
        const float d = view.measured(x, y);
        if (!(d > 0.0f) || d < edge - before_edge) return -1;
        return d <= edge + behind_edge ? 1 : d > edge + background ? 0 : -1;
      };
      const auto mask_at = [&](int step) {
        const auto [x, y] = pixel(step);
        if (!is_free(step) || view.frame.mask(x, y) == KeptFrame::not_known) return -1;
        return view.frame.mask(x, y) != 0 ? 1 : 0;
      };

      const Eigen::Vector3d p = camera_.ray(u, v) * edge;
      Eigen::Matrix<double, 2, 3> projection;
      projection << camera_.fx() / p.z(), 0.0, -camera_.fx() * p.x() / (p.z() * p.z()), 0.0,
          camera_.fy() / p.z(), -camera_.fy() * p.y() / (p.z() * p.z());
      const Eigen::Vector3d by_point = -(normal.transpose() * projection).transpose();
      Twist gradient;
      gradient << p.cross(by_point), by_point;
      const Eigen::Vector2d by_focal =
          -normal.cwiseProduct(Eigen::Vector2d(u - camera_.cx(), v - camera_.cy()));
      const auto add = [&](Kind kind, double value) {
        add_row(view,
                {.kind = kind,
                 .link = static_cast<std::uint16_t>(view.robot.links(u, v) - 1),
                 .frame = view.number,
                 .value = value},
                gradient, by_focal, p / edge, out);
        return out.rows.data() + out.rows.size() - unknowns_.size();
      };
      const bool has_depth = !view.frame.depth.empty();
      const int pixels = static_cast<int>(reach.pixels);
      if (const auto step = has_depth ? step_of(depth_at, pixels) : step_of(mask_at, pixels)) {
        double* const row = add(Kind::edge, *step + view.rest().dot(normal) - view.state.outline);
        row[Unknowns::outline] = -1.0;
        if (unknowns_.has_shift) Eigen::Map<Eigen::Vector2d>(row + Unknowns::shift) = normal;
      }
      if (has_depth && !view.frame.mask.empty())
        if (const auto step = step_of(mask_at, mask_reach)) add(Kind::mask, *step);
    }
}

FrameFit Observer::fit(const KeptFrame& frame, const State& state) {
  const VirtualDepthView robot = render(frame, state);
  const View view{.frame = frame, .number = 0, .state = state, .robot = robot, .link_twists = {}};
  Overlap agreeing;  // of what is measured, without depth of robot and mask
  if (frame.depth.empty()) agreeing.add(robot.depth, frame.mask);
  for (int v = 0; v < robot.depth.height && !frame.depth.empty(); v += stride_)
    for (int u = 0; u < robot.depth.width; u += stride_) {
      const float expected = robot.depth(u, v);
      const float d = expected > 0.0f ? view.measured(u, v) : 0.0f;
      if (!(d > 0.0f)) continue;
      ++agreeing.either;
      agreeing.both += std::abs(d - expected) < agreeing_depth;
    }
  Residuals residuals;
  observe(frame, 0, state, {.depth = agreeing_depth, .pixels = 12.0}, residuals);
  std::array<std::vector<double>, kinds> sizes;
  for (const Residual& residual : residuals.list)
    sizes[static_cast<std::size_t>(residual.kind)].push_back(std::abs(residual.value));
  return {.index = frame.index,
          .used = true,
          .agreeing = agreeing.share(),
          .residual = detail::median(sizes[static_cast<std::size_t>(Kind::surface)]),
          .outline = detail::median(sizes[static_cast<std::size_t>(Kind::edge)])};
}

double Observer::information(const KeptFrame& frame, const State& state, const Twist& direction) {
  constexpr std::array<double, kinds> sigmas{0.003, 1.0, 1.0};  // metres, pixels, pixels
  KeptFrame seen = frame;
  const VirtualDepthView robot = render(frame, state);
  if (unknowns_.holds_depth)
    seen.mask = Image<std::uint8_t>(robot.depth.width, robot.depth.height);
  else
    seen.depth = Image<float>(robot.depth.width, robot.depth.height);
  for (int v = 0; v < robot.depth.height; ++v)
    for (int u = 0; u < robot.depth.width; ++u)
      if (unknowns_.holds_depth)
        seen.mask(u, v) = robot.depth(u, v) > 0.0f;
      else
        seen.depth(u, v) = robot.depth(u, v);
  State exact = state;  // the sensor measures what is rendered
  exact.depth_offset = exact.depth_scale = exact.outline = 0.0;
  exact.depth_shift.setZero();
  exact.time_offset = 0.0;
  Residuals residuals;
  observe(seen, 0, exact, {.depth = agreeing_depth, .pixels = 2.0}, residuals);
  double sum = 0.0;
  for (std::size_t i = 0; i < residuals.list.size(); ++i) {
    const double* const row =
        residuals.rows.data() + i * static_cast<std::size_t>(unknowns_.size());
    const double change = Eigen::Map<const Twist>(row).dot(direction) /
                          sigmas[static_cast<std::size_t>(residuals.list[i].kind)];
    sum += change * change;
  }
  return sum;
}

void Overlap::add(const ImageView<const float>& robot, const Image<std::uint8_t>& mask) {
  for (int v = 0; v < robot.height; ++v)
    for (int u = 0; u < robot.width; ++u) {
      if (mask(u, v) == KeptFrame::not_known) continue;
      const bool rendered = robot(u, v) > 0.0f, seen = mask(u, v) != 0;
      both += rendered && seen;
      either += rendered || seen;
    }
}

}  // namespace penumbra::calibration
