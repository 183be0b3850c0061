// SPDX-License-Identifier: Apache-2.0
#include "object_beside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <penumbra/base/error.hpp>

namespace penumbra::test {
namespace {

/// A part of the hand: all points up to `radius` from a line.
struct Capsule {
  double x0, y0, x1, y1, radius;  // shares of the palm's width

  [[nodiscard]] double inside(double x, double y) const {
    const double dx = x1 - x0, dy = y1 - y0;
    const double length2 = dx * dx + dy * dy;
    const double along =
        length2 == 0.0 ? 0.0 : std::clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0.0, 1.0);
    return radius - std::hypot(x - x0 - along * dx, y - y0 - along * dy);
  }
};

constexpr std::array<Capsule, 6> hand = {{{-0.05, 0.0, 0.05, 0.0, 0.45},
                                          {-0.38, -0.3, -0.46, -1.05, 0.11},
                                          {-0.13, -0.4, -0.16, -1.25, 0.11},
                                          {0.12, -0.4, 0.14, -1.2, 0.11},
                                          {0.36, -0.3, 0.44, -0.95, 0.10},
                                          {0.3, 0.1, 0.85, -0.3, 0.12}}};

/// Metres behind the nearest point of a cylinder, `inside` metres from its edge.
double bulge(double radius, double inside) {
  const double from_axis = std::clamp(radius - inside, 0.0, radius);
  return radius - std::sqrt(radius * radius - from_axis * from_axis);
}

}  // namespace

SurfaceHit SideObject::at(double x, double y) const {
  const double across = width / 2 - std::abs(x), along = height / 2 - std::abs(y);
  switch (outline) {
    case Outline::plate:
      return {0.0, std::min(across, along)};
    case Outline::disc:
      return {0.0, width / 2 - std::hypot(x, y)};
    case Outline::cylinder:
    case Outline::rod:
      return {bulge(width / 2, across), std::min(across, along)};
    case Outline::hand:
      break;
  }
  SurfaceHit hit{relief(), -1.0};
  for (const Capsule& part : hand) {
    const double inside = width * part.inside(x / width, y / width);
    hit.inside = std::max(hit.inside, inside);
    // Fingers are round; the palm is as thick as one of them, but for its rim.
    const double radius = std::min(width * part.radius, relief());
    if (inside > 0.0) hit.depth = std::min(hit.depth, relief() - radius + bulge(radius, inside));
  }
  return hit;
}

double SideObject::radius() const {
  return outline == Outline::hand ? 1.4 * width : std::hypot(width, height) / 2;
}

double SideObject::relief() const {
  if (outline == Outline::hand) return 0.11 * width;
  return outline == Outline::plate || outline == Outline::disc ? 0.0 : width / 2;
}

SurfaceHit SidePaster::Place::hit(const RealFrame& frame, double du, double dv) const {
  const double c = std::cos(turn), s = std::sin(turn), scale = z / frame.intrinsics.fx();
  SurfaceHit hit = object.at(scale * (c * du + s * dv), scale * (c * dv - s * du));
  hit.depth += z;
  return hit;
}

/// Calls f(u, v, hit) for the image's pixels up to `margin` from the object, and some more.
template <typename F>
void SidePaster::Place::for_each_pixel(const RealFrame& frame, double margin, F&& f) const {
  const Intrinsics& k = frame.intrinsics;
  const int reach = static_cast<int>(object.radius() * k.fx() / z + margin) + 2;
  const int cu = static_cast<int>(u), cv = static_cast<int>(v);
  for (int y = std::max(0, cv - reach); y <= std::min(k.height() - 1, cv + reach); ++y)
    for (int x = std::max(0, cu - reach); x <= std::min(k.width() - 1, cu + reach); ++x)
      f(x, y, hit(frame, x - u, y - v));
}

/// The pixels along its outline and some of those inside, which tell whether it touches the robot.
std::vector<SidePaster::Offset> SidePaster::outline(const RealFrame& frame) const {
  constexpr int every = 8;  // pixels
  std::vector<Offset> offsets;
  const double pixel = place_.z / frame.intrinsics.fx();  // metres
  const int reach = static_cast<int>(place_.object.radius() / pixel) + 2;
  for (int dv = -reach; dv <= reach; ++dv)
    for (int du = -reach; du <= reach; ++du) {
      const double inside = place_.hit(frame, du, dv).inside;
      const bool on_grid = du % every == 0 && dv % every == 0;
      if (inside > 0.0 && (inside < 1.5 * pixel || on_grid)) offsets.push_back({du, dv});
    }
  return offsets;
}

int SidePaster::random_robot_pixel(const RealFrame& frame) {
  for (;;) {
    const int pixel = frame.robot_indices[paste_.random()() % frame.robot_indices.size()];
    if (pixel / frame.intrinsics.width() < air_rows) return pixel;
  }
}

/// Moves the place in a direction until the object is `least` pixels from the silhouette.
bool SidePaster::slide_off(const NearestRobot& nearest, const std::vector<Offset>& pixels,
                           double least, double angle) {
  constexpr double slack = 1.5, longest = 400.0;  // pixels
  const int width = nearest.squared.width();
  const double u0 = place_.u, v0 = place_.v;
  for (double moved = 0.0; moved < longest; moved += 1.0) {
    place_.u = std::round(u0 + moved * std::cos(angle));
    place_.v = std::round(v0 + moved * std::sin(angle));
    int closest = NearestRobot::far;
    for (const Offset& pixel : pixels) {
      const int u = static_cast<int>(place_.u) + pixel.du;
      const int v = static_cast<int>(place_.v) + pixel.dv;
      if (u < 0 || v < 0 || u >= width || v >= air_rows) {
        closest = -1;
        break;
      }
      if (nearest.squared(u, v) >= closest) continue;
      closest = nearest.squared(u, v);
      nearest_depth_ = nearest.depth(u, v);
      if (closest < least * least) break;
    }
    if (closest < least * least) continue;
    place_.clearance = std::sqrt(closest);
    return place_.clearance <= least + slack;
  }
  return false;
}

bool SidePaster::find_place(const RealFrame& frame, const NearestRobot& nearest, const Gap& gap,
                            double offset) {
  constexpr double close = 0.003;  // metres
  const int pixel = random_robot_pixel(frame);
  const int u = pixel % frame.intrinsics.width(), v = pixel / frame.intrinsics.width();
  place_.turn = uniform(paste_.random(), 0.0, 2 * std::numbers::pi);
  const double angle = uniform(paste_.random(), 0.0, 2 * std::numbers::pi);
  place_.z = static_cast<double>(frame.robot(u, v)) + offset;
  // Another depth is another size, which may come near to another pixel.
  for (int round = 0; round < 4; ++round) {
    place_.u = u;
    place_.v = v;
    const double least = std::max(1.0, gap.pixels + gap.metres * frame.intrinsics.fx() / place_.z);
    if (least > NearestRobot::reach - 2 || !slide_off(nearest, outline(frame), least, angle))
      return false;
    const double wanted = static_cast<double>(nearest_depth_) + offset;
    if (std::abs(wanted - place_.z) < close) return true;
    place_.z = wanted;
  }
  return false;
}

void SidePaster::paste_at_place(RealFrame& frame) {
  paste_.begin();
  place_.for_each_pixel(frame, 2.0, [&](int u, int v, const SurfaceHit& hit) {
    const auto robot = static_cast<double>(frame.robot(u, v));
    if (robot <= 0.0 || hit.depth < robot) paste_.add(frame, hit, u, v);
  });
}

void SidePaster::paste(RealFrame& frame, const NearestRobot& nearest, const SideObject& object,
                       const Gap& gap, double offset) {
  constexpr int attempts = 100000;
  place_.object = object;
  for (int i = 0; !find_place(frame, nearest, gap, offset); ++i)
    if (i == attempts) throw InputError("an object finds no place beside the arm");
  paste_at_place(frame);
}

void SidePaster::paste_across(RealFrame& frame, const SideObject& object, double offset) {
  const int pixel = random_robot_pixel(frame);
  const int u = pixel % frame.intrinsics.width(), v = pixel / frame.intrinsics.width();
  place_ = {object, static_cast<double>(u), static_cast<double>(v),
            static_cast<double>(frame.robot(u, v)) + offset,
            uniform(paste_.random(), 0.0, 2 * std::numbers::pi)};
  paste_at_place(frame);
}

bool SidePaster::has_true_step(const RealFrame& frame, double step, double margin) const {
  const double first = place_.z - step, last = place_.z + place_.object.relief() + step;
  const auto differs = [&](double depth) {
    return depth <= 0.0 || depth <= first || depth >= last;
  };
  bool is_step = true;
  place_.for_each_pixel(frame, margin, [&](int u, int v, const SurfaceHit& hit) {
    const auto robot = static_cast<double>(frame.robot(u, v));
    if (robot <= 0.0 || hit.inside * frame.intrinsics.fx() / place_.z < -margin) return;
    is_step &= differs(robot) && differs(0.001 * static_cast<double>(frame.measured(u, v)));
  });
  return is_step;
}

}  // namespace penumbra::test
