// SPDX-License-Identifier: Apache-2.0
#include "pasted_objects.hpp"

#include "pixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <penumbra/base/error.hpp>

namespace penumbra::test {
namespace {

// The sensor's noise, measured on the xArm recording: the local spread of measured against virtual
// depth inside smooth parts of the robot is 1 mm x z^2 in windows of 5 pixels and 3 mm x z^2 in
// windows of 21, half of the frames above and below.
constexpr double patchy = 0.0028;      // metres per square metre; Gaussian patches
constexpr double patch_sigma = 4.0;    // pixels
constexpr double white = 0.0008;       // metres per square metre, pixel by pixel
constexpr double edge = 2.0;           // pixels on both sides of the outline that may be mixed
constexpr double mixed = 0.3;          // share of those with a depth between object and background
constexpr double edge_holes = 0.15;    // share of those without measurement
constexpr double inside_holes = 0.01;  // share of the object's other pixels without measurement
constexpr int patches_size = 512;

/// White noise smoothed by a Gaussian, wrapping around, brought to spread 1.
Image<float> gaussian_patches(std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  Image<float> image(patches_size, patches_size), smooth(patches_size, patches_size);
  std::generate_n(image.data(), image.size(), [&] { return normal(random); });
  const int reach = int(std::ceil(3 * patch_sigma));
  for (const bool across : {true, false}) {
    for (const auto [u, v] : each_pixel(0, 0, patches_size, patches_size)) {
      double sum = 0.0;
      for (int i = -reach; i <= reach; ++i) {
        const double weight = std::exp(-0.5 * i * i / (patch_sigma * patch_sigma));
        const int x = (u + (across ? i : 0)) & (patches_size - 1);
        const int y = (v + (across ? 0 : i)) & (patches_size - 1);
        sum += weight * double(image(x, y));
      }
      smooth(u, v) = float(sum);
    }
    std::swap(image, smooth);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i)
    squares += double(image.data()[i]) * double(image.data()[i]);
  const auto spread = float(std::sqrt(squares / double(image.size())));
  std::for_each(image.data(), image.data() + image.size(), [&](float& x) { x /= spread; });
  return image;
}

/// A part of the hand: all points up to `radius` from a line.
struct Capsule {
  double x0, y0, x1, y1, radius;  // shares of the palm's width

  [[nodiscard]] double inside(double x, double y) const {
    const double dx = x1 - x0, dy = y1 - y0;
    const double along =
        std::clamp(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return radius - std::hypot(x - x0 - along * dx, y - y0 - along * dy);
  }
};

constexpr std::array<Capsule, 6> hand = {{{-0.05, 0.0, 0.05, 0.0, 0.45},
                                          {-0.38, -0.3, -0.46, -1.05, 0.11},
                                          {-0.13, -0.4, -0.16, -1.25, 0.11},
                                          {0.12, -0.4, 0.14, -1.2, 0.11},
                                          {0.36, -0.3, 0.44, -0.95, 0.10},
                                          {0.3, 0.1, 0.85, -0.3, 0.12}}};

/// The radius of a circle that holds the object, and its nearest to its farthest point; metres.
double radius_of(const PastedObject& object) {
  return (object.outline == Outline::hand ? 1.4 : 0.5 * std::numbers::sqrt2) * object.width;
}
double relief_of(const PastedObject& object) {
  return object.outline == Outline::hand ? 0.11 * object.width : 0.0;
}

}  // namespace

Paster::Hit Paster::Place::hit(const RealFrame& frame, double du, double dv) const {
  const double c = std::cos(turn), s = std::sin(turn), scale = z / frame.intrinsics.fx();
  const double x = scale * (c * du + s * dv), y = scale * (c * dv - s * du);
  const double half = object.width / 2;
  if (object.outline == Outline::plate) return {z, half - std::max(std::abs(x), std::abs(y))};
  if (object.outline == Outline::disc) return {z, half - std::hypot(x, y)};
  const double relief = relief_of(object);
  Hit hit{z + relief, -1.0};
  for (const Capsule& part : hand) {
    const double inside = object.width * part.inside(x / object.width, y / object.width);
    hit.inside = std::max(hit.inside, inside);
    // Fingers are round; the palm is as thick as one of them, with a round rim.
    const double radius = std::min(object.width * part.radius, relief);
    const double from_axis = std::clamp(radius - inside, 0.0, radius);
    if (inside > 0.0)
      hit.depth =
          std::min(hit.depth, z + relief - std::sqrt(radius * radius - from_axis * from_axis));
  }
  return hit;
}

/// Calls f(u, v, hit) for the image's pixels up to `margin` from the object, and some more.
template <typename F>
void Paster::Place::for_each_pixel(const RealFrame& frame, double margin, F&& f) const {
  const Intrinsics& k = frame.intrinsics;
  const int reach = int(radius_of(object) * k.fx() / z + margin) + 2;
  const int cu = int(u), cv = int(v);
  for (int y = std::max(0, cv - reach); y <= std::min(k.height() - 1, cv + reach); ++y)
    for (int x = std::max(0, cu - reach); x <= std::min(k.width() - 1, cu + reach); ++x)
      f(x, y, hit(frame, x - u, y - v));
}

Paster::Paster(std::mt19937_64::result_type seed)
    : random_(seed), patches_(gaussian_patches(random_)) {}

double Paster::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random_);
}

/// The pixels along the outline and some of those inside, which decide whether the object touches
/// the robot.
std::vector<Paster::Offset> Paster::outline(const RealFrame& frame) const {
  constexpr int every = 8;  // pixels
  std::vector<Offset> offsets;
  const double pixel = place_.z / frame.intrinsics.fx();  // metres
  const int reach = int(radius_of(place_.object) / pixel) + 2;
  for (int dv = -reach; dv <= reach; ++dv)
    for (int du = -reach; du <= reach; ++du) {
      const double inside = place_.hit(frame, du, dv).inside;
      const bool on_grid = du % every == 0 && dv % every == 0;
      if (inside > 0.0 && (inside < 1.5 * pixel || on_grid)) offsets.push_back({du, dv});
    }
  return offsets;
}

/// Moves the place in a direction until the object is `least` pixels from the robot.
bool Paster::slide_off(const RealFrame& frame, const tuning::NearestPixels& nearest, double least,
                       double angle) {
  constexpr double slack = 1.5, longest = 400.0;  // pixels
  const std::vector<Offset> pixels = outline(frame);
  const double u0 = place_.u, v0 = place_.v;
  for (double moved = 0.0; moved < longest; moved += 1.0) {
    place_.u = std::round(u0 + moved * std::cos(angle));
    place_.v = std::round(v0 + moved * std::sin(angle));
    double closest = std::numeric_limits<double>::infinity();
    for (const Offset& pixel : pixels) {
      const int u = int(place_.u) + pixel.du;
      const int v = int(place_.v) + pixel.dv;
      if (u < 0 || v < 0 || u >= frame.robot.width() || v >= frame.air_rows()) return false;
      const double distance = nearest.distance(u, v);
      if (distance >= closest) continue;
      closest = distance;
      const auto at = nearest.at(u, v);
      nearest_depth_ = double(frame.robot(at.u, at.v));
      if (closest < least) break;
    }
    if (closest >= least) return closest <= least + slack;
  }
  return false;
}

bool Paster::find_place(const RealFrame& frame, const tuning::NearestPixels& nearest, double gap,
                        double offset) {
  constexpr double close = 0.003;  // metres
  const int pixel = frame.robot_indices[random_() % frame.robot_indices.size()];
  const int u = pixel % frame.intrinsics.width(), v = pixel / frame.intrinsics.width();
  if (v >= frame.air_rows()) return false;
  place_.turn = uniform(0.0, 2 * std::numbers::pi);
  const double angle = uniform(0.0, 2 * std::numbers::pi);
  place_.z = double(frame.robot(u, v)) + offset;
  // Another depth is another size, which may come near to another pixel.
  for (int round = 0; round < 4; ++round) {
    place_.u = u;
    place_.v = v;
    const double least = std::max(1.0, gap * frame.intrinsics.fx() / place_.z);
    if (!slide_off(frame, nearest, least, angle)) return false;
    const double wanted = nearest_depth_ + offset;
    if (std::abs(wanted - place_.z) < close) return true;
    place_.z = wanted;
  }
  return false;
}

void Paster::paste_beside(RealFrame& frame, const tuning::NearestPixels& nearest,
                          const PastedObject& object, double gap, double offset) {
  constexpr int attempts = 100000;
  place_.object = object;
  for (int i = 0; !find_place(frame, nearest, gap, offset); ++i)
    if (i == attempts) throw InputError("an object finds no place beside the arm");
  paste(frame);
}

void Paster::paste_before(RealFrame& frame, const PastedObject& object, double gap) {
  const int pixel = frame.robot_indices[random_() % frame.robot_indices.size()];
  const int u = pixel % frame.intrinsics.width(), v = pixel / frame.intrinsics.width();
  place_ = {object, double(u), double(v), double(frame.robot(u, v)) - gap,
            uniform(0.0, 2 * std::numbers::pi)};
  // Bring it nearer until all of it keeps the gap; what is under it changes a little on the way.
  for (double excess = 1.0; excess > 1e-4;) {
    double nearest = std::numeric_limits<double>::infinity();
    place_.for_each_pixel(frame, edge, [&](int x, int y, const Hit& hit) {
      if (hit.inside >= 0.0 && frame.robot(x, y) > 0.0F)
        nearest = std::min(nearest, double(frame.robot(x, y)));
    });
    excess = place_.z + relief_of(object) - (nearest - gap);
    place_.z -= std::max(0.0, excess);
  }
  paste(frame);
}

void Paster::paste(RealFrame& frame) {
  on_robot_.clear();
  beside_.clear();
  before_.clear();
  shift_u_ = int(random_() % patches_size);
  shift_v_ = int(random_() % patches_size);
  place_.for_each_pixel(frame, edge, [&](int u, int v, const Hit& hit) {
    const auto robot = double(frame.robot(u, v));
    if (robot <= 0.0 || hit.depth < robot) measure(frame, hit, u, v);
  });
}

double Paster::noise(double z, int u, int v) {
  const auto patch =
      double(patches_((u + shift_u_) & (patches_size - 1), (v + shift_v_) & (patches_size - 1)));
  return z * z * (patchy * patch + white * std::normal_distribution<double>()(random_));
}

void Paster::measure(RealFrame& frame, const Hit& hit, int u, int v) {
  const double inside = hit.inside * frame.intrinsics.fx() / hit.depth;  // pixels
  if (!(inside > -edge)) return;
  const double object = hit.depth + noise(hit.depth, u, v);
  const double behind = 0.001 * double(frame.measured(u, v));
  const bool at_edge = inside < edge;
  double z = inside > 0.0 ? object : behind;
  if (at_edge && behind > 0.0 && uniform(0.0, 1.0) < mixed) {
    const double share = 0.5 + 0.5 * inside / edge;
    z = share * object + (1.0 - share) * behind;
  }
  if (uniform(0.0, 1.0) < (at_edge ? edge_holes : inside_holes)) z = 0.0;
  const int pixel = v * frame.intrinsics.width() + u;
  before_.emplace_back(pixel, frame.measured(u, v));
  frame.measured(u, v) = std::uint16_t(std::lround(1000.0 * z));
  if (!at_edge && z > 0.0) (frame.robot(u, v) > 0.0F ? on_robot_ : beside_).push_back(pixel);
}

void Paster::undo(RealFrame& frame) {
  for (const auto& [pixel, depth] : before_) frame.measured.data()[pixel] = depth;
  before_.clear();
}

bool Paster::has_true_step(const RealFrame& frame) const {
  constexpr double step = 0.05, margin = 12.0;  // metres, pixels
  const double first = place_.z - step, last = place_.z + relief_of(place_.object) + step;
  const auto differs = [&](double depth) {
    return depth <= 0.0 || depth <= first || depth >= last;
  };
  bool is_step = true;
  place_.for_each_pixel(frame, margin, [&](int u, int v, const Hit& hit) {
    const auto robot = double(frame.robot(u, v));
    if (robot <= 0.0 || hit.inside * frame.intrinsics.fx() / place_.z < -margin) return;
    is_step &= differs(robot) && differs(0.001 * double(frame.measured(u, v)));
  });
  return is_step;
}

}  // namespace penumbra::test
