// SPDX-License-Identifier: Apache-2.0
#include "scene.hpp"

#include <algorithm>
#include <cmath>

namespace example {
namespace {

constexpr double surface_gap = 1e-4;  // metres that a shadow ray starts off its surface

Isometry3d at(double x, double y, double z, double yaw = 0.0) {
  return Origin{{x, y, z}, {0.0, 0.0, yaw}}.transform();
}

/// 0 before a, 1 after b, smooth between.
double ramp(double a, double b, double x) {
  const double s = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

Shape bottle() {
  return std::make_shared<const TracedMesh>(turned({{0.034, 0.000},
                                                    {0.037, 0.004},
                                                    {0.037, 0.130},
                                                    {0.030, 0.160},
                                                    {0.014, 0.190},
                                                    {0.013, 0.225},
                                                    {0.016, 0.227},
                                                    {0.016, 0.240},
                                                    {0.013, 0.242}},
                                                   40));
}

/// A capsule's pose from one end's centre to the other's.
Isometry3d between(const Vector3d& a, const Vector3d& b) {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), b - a).toRotationMatrix();
  T.translation() = (a + b) / 2.0;
  return T;
}

struct Bone {
  Vector3d from, to;  // in the hand's frame: fingers along x, thumb's side y
  double radius;
};

const std::vector<Bone>& bones() {
  static const std::vector<Bone> all{{{-0.26, 0.00, 0.00}, {0.00, 0.00, 0.00}, 0.030},
                                     {{0.00, 0.018, 0.00}, {0.085, 0.030, 0.00}, 0.014},
                                     {{0.00, 0.006, 0.00}, {0.090, 0.010, 0.00}, 0.014},
                                     {{0.00, -0.006, 0.00}, {0.086, -0.010, 0.00}, 0.014},
                                     {{0.00, -0.018, 0.00}, {0.076, -0.029, 0.00}, 0.013},
                                     {{0.085, 0.030, 0.00}, {0.125, 0.036, -0.008}, 0.0095},
                                     {{0.125, 0.036, -0.008}, {0.152, 0.038, -0.022}, 0.0085},
                                     {{0.090, 0.010, 0.00}, {0.136, 0.012, -0.008}, 0.0095},
                                     {{0.136, 0.012, -0.008}, {0.166, 0.012, -0.024}, 0.0085},
                                     {{0.086, -0.010, 0.00}, {0.128, -0.013, -0.008}, 0.0095},
                                     {{0.128, -0.013, -0.008}, {0.156, -0.014, -0.023}, 0.0085},
                                     {{0.076, -0.029, 0.00}, {0.108, -0.036, -0.007}, 0.0085},
                                     {{0.108, -0.036, -0.007}, {0.128, -0.039, -0.018}, 0.0075},
                                     {{0.010, 0.020, 0.00}, {0.046, 0.054, -0.010}, 0.013},
                                     {{0.046, 0.054, -0.010}, {0.082, 0.066, -0.018}, 0.010}};
  return all;
}

}  // namespace

Arm::Values Scene::joints(int frame) {
  const double s = static_cast<double>(frame) / (frame_count - 1);
  const double lift = 0.50 + 0.25 * ramp(0.0, 0.6, s) - 0.20 * ramp(0.6, 1.0, s);
  const double elbow = 1.25 - 0.30 * ramp(0.1, 0.5, s) + 0.45 * ramp(0.55, 1.0, s);
  const double level = 1.5708 - lift - elbow;  // keeps the tool upright
  const Arm::Values exact{-0.70 + 1.75 * s,
                          lift,
                          elbow,
                          level,
                          -1.5708,
                          0.4 - 1.1 * s,
                          0.010 + 0.028 * ramp(0.3, 0.9, s)};
  Arm::Values written{};
  std::transform(exact.begin(), exact.end(), written.begin(),
                 [](double q) { return std::round(q * 1e6) / 1e6; });
  return written;
}

Scene::Scene(const Arm& arm, int frame) {
  add_room();
  add_objects();
  add_hand(frame);
  const auto poses = arm.part_poses(joints(frame));
  for (std::size_t i = 0; i < poses.size(); ++i)
    add(Kind::robot, arm.parts()[i].colour(), Finish::gloss, arm.parts()[i].shape, poses[i]);
}

void Scene::add(Kind kind, const Vector3d& colour, Finish finish, const Shape& shape,
                const Isometry3d& pose) {
  things_.push_back({kind, colour, finish, shape, pose, pose.inverse(), bounds(shape)});
}

void Scene::add_room() {
  add(Kind::room, {0.74, 0.75, 0.76}, Finish::tiles, Box{{8.0, 8.0, 0.1}}, at(0.0, 0.0, -0.79));
  add(Kind::room, {0.96, 0.95, 0.92}, Finish::plain, Box{{8.0, 0.1, 6.0}}, at(0.0, 1.55, 0.8));
  add(Kind::room, {0.90, 0.94, 0.95}, Finish::plain, Box{{0.1, 8.0, 6.0}}, at(-1.65, 0.0, 0.8));
  add(Kind::room, {0.72, 0.57, 0.41}, Finish::wood, Box{{1.50, 1.30, 0.04}}, at(0.25, 0.05, -0.02));
  for (const double x : {-0.43, 0.93})
    for (const double y : {-0.53, 0.63})
      add(Kind::room, {0.30, 0.31, 0.33}, Finish::plain, Cylinder{0.03, 0.70}, at(x, y, -0.39));
}

void Scene::add_objects() {
  const auto object = [this](const Vector3d& colour, const Shape& shape, const Isometry3d& pose) {
    add(Kind::object, colour, Finish::plain, shape, pose);
  };
  // Before the arm.
  object({0.70, 0.52, 0.34}, Box{{0.11, 0.08, 0.17}}, at(0.14, -0.34, 0.085, 0.5));
  object({0.78, 0.20, 0.17}, Cylinder{0.042, 0.096}, at(0.40, -0.40, 0.048));
  object({0.90, 0.66, 0.16}, Sphere{0.048}, at(-0.02, -0.44, 0.048));
  // Behind it.
  object({0.22, 0.42, 0.62}, Box{{0.30, 0.20, 0.16}}, at(-0.18, 0.36, 0.080, 0.2));
  object({0.20, 0.50, 0.36}, bottle(), at(0.16, 0.36, 0.0));
  object({0.88, 0.78, 0.25}, Box{{0.08, 0.08, 0.08}}, at(0.52, 0.28, 0.040, 0.6));
  object({0.55, 0.33, 0.55}, Cylinder{0.055, 0.30}, at(0.42, 0.56, 0.150));
  object({0.82, 0.82, 0.80}, Box{{0.16, 0.10, 0.24}}, at(-0.02, 0.58, 0.120, -0.3));
}

// A hand that comes from the right, stays before the arm and leaves.
void Scene::add_hand(int frame) {
  const double out = 1.0 - ramp(2.0, 5.5, frame) + ramp(7.5, 11.0, frame);
  Isometry3d hand = Isometry3d::Identity();
  hand.translation() = Vector3d(0.50, -0.34, 0.44) + out * Vector3d(0.62, 0.29, -0.05);
  hand.linear() =
      (Eigen::AngleAxisd(3.45, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.15, Vector3d::UnitY()) *
       Eigen::AngleAxisd(-2.1, Vector3d::UnitX()))
          .toRotationMatrix();
  for (const auto& bone : bones())
    add(Kind::object, {0.84, 0.62, 0.51}, Finish::plain,
        Capsule{bone.radius, (bone.to - bone.from).norm()}, hand * between(bone.from, bone.to));
  add(Kind::object, {0.20, 0.24, 0.40}, Finish::plain, Capsule{0.042, 0.40},
      hand * between({-0.60, 0.0, 0.0}, {-0.20, 0.0, 0.0}));
}

Seen Scene::nearest(const Ray& ray) const {
  Seen best;
  for (const Kind kind : {Kind::room, Kind::object, Kind::robot}) {
    const Seen seen = nearest(ray, kind);
    if (seen.t < best.t) best = seen;
  }
  return best;
}

Seen Scene::nearest(const Ray& ray, Kind kind) const {
  Seen best;
  for (const auto& thing : things_) {
    if (thing.kind != kind) continue;
    const Ray local{thing.inverse * ray.origin, thing.inverse.linear() * ray.direction};
    const auto hit = meets(thing.box, local) ? intersect(thing.shape, local) : std::nullopt;
    if (!hit || hit->t >= best.t) continue;
    const Vector3d normal = (thing.pose.linear() * hit->normal).normalized();
    best = {&thing, hit->t, normal.dot(ray.direction) > 0.0 ? Vector3d(-normal) : normal};
  }
  return best;
}

bool Scene::blocked(const Vector3d& point, const Vector3d& to_light) const {
  const Ray ray{point + surface_gap * to_light.normalized(), to_light};
  return std::any_of(things_.begin(), things_.end(), [&](const Thing& thing) {
    const Ray local{thing.inverse * ray.origin, thing.inverse.linear() * ray.direction};
    const auto hit = meets(thing.box, local) ? intersect(thing.shape, local) : std::nullopt;
    return hit && hit->t < 1.0;
  });
}

View::View() {
  const Vector3d eye(0.93, -1.22, 0.70), target(0.20, 0.02, 0.22);
  T_base_camera = Isometry3d::Identity();
  const Vector3d z = (target - eye).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  T_base_camera.linear() << x, z.cross(x), z;
  T_base_camera.translation() = eye;
}

Ray View::ray(double u, double v) const {
  return {T_base_camera.translation(),
          T_base_camera.linear() * Vector3d((u - cx) / fx, (v - cy) / fy, 1.0)};
}

}  // namespace example
