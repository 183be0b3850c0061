// SPDX-License-Identifier: Apache-2.0
#include "pasted_object.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace penumbra::test {
namespace {

constexpr int patches_size = 512;

double uniform(std::mt19937_64& random, double low = 0.0, double high = 1.0) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// White noise smoothed by a Gaussian, wrapping around, brought to spread 1.
Image<float> gaussian_patches(double sigma, std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  Image<float> image(patches_size, patches_size), smooth(patches_size, patches_size);
  std::generate_n(image.data(), image.size(), [&] { return normal(random); });
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  for (const bool across : {true, false}) {
    for (int v = 0; v < patches_size; ++v) {
      for (int u = 0; u < patches_size; ++u) {
        double sum = 0.0;
        for (int i = -reach; i <= reach; ++i) {
          const double weight = std::exp(-0.5 * i * i / (sigma * sigma));
          const int x = (u + (across ? i : 0)) & (patches_size - 1);
          const int y = (v + (across ? 0 : i)) & (patches_size - 1);
          sum += weight * static_cast<double>(image(x, y));
        }
        smooth(u, v) = static_cast<float>(sum);
      }
    }
    std::swap(image, smooth);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i)
    squares += static_cast<double>(image.data()[i]) * static_cast<double>(image.data()[i]);
  const auto spread = static_cast<float>(std::sqrt(squares / static_cast<double>(image.size())));
  std::for_each(image.data(), image.data() + image.size(), [&](float& x) { x /= spread; });
  return image;
}

}  // namespace

/// A plate in the camera's frame.
struct Paster::Plate {
  ObjectKind kind;
  Eigen::Matrix3d rotation;  // columns: the plate's axes and normal
  Eigen::Vector3d centre;

  struct Hit {
    double depth;   ///< metres; not finite if the ray runs along the plate
    double inside;  ///< metres from the outline, positive inside
  };

  [[nodiscard]] Hit hit(const Eigen::Vector3d& ray) const {
    const double depth = rotation.col(2).dot(centre) / rotation.col(2).dot(ray);
    const Eigen::Vector3d p = rotation.transpose() * (depth * ray - centre);
    const double from_centre = kind.shape == Shape::square
                                   ? std::max(std::abs(p.x()), std::abs(p.y()))
                                   : std::hypot(p.x(), p.y());
    return {depth, kind.size / 2 - from_centre};
  }

  /// Half the width of the pixel window that holds the plate and its edge.
  [[nodiscard]] int window(const Intrinsics& camera) const {
    return static_cast<int>(0.75 * kind.size * camera.fx() / (centre.z() - kind.size / 2)) + 6;
  }

  /// Calls f(u, v, hit) for the pixels that the window and the image share.
  template <typename F>
  void for_each_pixel(const Intrinsics& camera, F&& f) const {
    const Eigen::Vector2d middle = camera.project(centre);
    const int reach = window(camera);
    const int u0 = static_cast<int>(middle.x()), v0 = static_cast<int>(middle.y());
    for (int v = std::max(0, v0 - reach); v <= std::min(camera.height() - 1, v0 + reach); ++v)
      for (int u = std::max(0, u0 - reach); u <= std::min(camera.width() - 1, u0 + reach); ++u)
        f(u, v, hit(camera.ray(u, v)));
  }
};

Paster::Paster(const SensorModel& model, std::mt19937_64::result_type seed)
    : model_(model), random_(seed), patches_(gaussian_patches(model.patch_sigma, random_)) {}

double Paster::noise(double z, int u, int v) {
  const auto patch = static_cast<double>(
      patches_((u + shift_u_) & (patches_size - 1), (v + shift_v_) & (patches_size - 1)));
  const double white = std::normal_distribution<double>()(random_);
  return z * z * (model_.patchy * patch + model_.white * white);
}

Paster::Plate Paster::place(const RealFrame& frame, const ObjectKind& kind, double gap) {
  const int width = frame.intrinsics.width();
  const int pixel = frame.robot_indices[random_() % frame.robot_indices.size()];
  const int u = pixel % width, v = pixel / width;
  const double towards = uniform(random_, 0.0, 2 * std::numbers::pi);
  const double turn = uniform(random_, 0.0, 2 * std::numbers::pi);
  Plate plate{kind, {}, {}};
  const Eigen::Vector3d lean(std::cos(towards), std::sin(towards), 0.0);
  plate.rotation =
      (Eigen::AngleAxisd(kind.tilt, lean) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  // Bring it nearer until all of it keeps the gap; what is under it changes a little on the way.
  double z = static_cast<double>(frame.robot(u, v)) - gap;
  for (double excess = 1.0; excess > 1e-4;) {
    plate.centre = z * frame.intrinsics.ray(u, v);
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
    plate.for_each_pixel(frame.intrinsics, [&](int x, int y, const Plate::Hit& hit) {
      if (hit.inside < 0.0) return;
      farthest = std::max(farthest, hit.depth);
      if (frame.robot(x, y) > 0.0f)
        nearest = std::min(nearest, static_cast<double>(frame.robot(x, y)));
    });
    excess = farthest - (nearest - gap);
    z -= std::max(0.0, excess);
  }
  return plate;
}

void Paster::paste_pixel(RealFrame& frame, const Plate& plate, int u, int v) {
  const Plate::Hit hit = plate.hit(frame.intrinsics.ray(u, v));
  const double inside = hit.inside * frame.intrinsics.fx() / hit.depth;  // pixels
  if (!(inside > -model_.edge)) return;
  const double object = hit.depth + noise(hit.depth, u, v);
  const double behind = 0.001 * static_cast<double>(frame.measured(u, v));
  const bool at_edge = inside < model_.edge;
  double z = inside > 0.0 ? object : behind;
  if (at_edge && behind > 0.0 && uniform(random_) < model_.mixed) {
    const double share = 0.5 + 0.5 * inside / model_.edge;
    z = share * object + (1.0 - share) * behind;
  }
  if (uniform(random_) < (at_edge ? model_.edge_holes : model_.inside_holes)) z = 0.0;
  const int pixel = v * frame.intrinsics.width() + u;
  before_.emplace_back(pixel, frame.measured(u, v));
  frame.measured(u, v) = static_cast<std::uint16_t>(std::lround(1000.0 * z));
  if (inside <= 0.0 || z == 0.0 || !(frame.robot(u, v) > 0.0f)) return;
  (at_edge ? band_ : core_).push_back(pixel);
}

void Paster::paste(RealFrame& frame, const ObjectKind& kind, double gap) {
  core_.clear();
  band_.clear();
  before_.clear();
  shift_u_ = static_cast<int>(random_() % patches_size);
  shift_v_ = static_cast<int>(random_() % patches_size);
  const Plate plate = place(frame, kind, gap);
  plate.for_each_pixel(frame.intrinsics,
                       [&](int u, int v, const Plate::Hit&) { paste_pixel(frame, plate, u, v); });
}

void Paster::undo(RealFrame& frame) {
  for (const auto& [pixel, depth] : before_) frame.measured.data()[pixel] = depth;
  before_.clear();
}

}  // namespace penumbra::test
