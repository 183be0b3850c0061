// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <sim/random.hpp>
#include <sim/scene.hpp>

namespace penumbra::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int frames = 1000;
constexpr double nearest_target = 0.35;  // smallest distance of a target from the camera, metres
constexpr double gap = 0.05;  // metres of depth between a target and the part of the arm there
// Nothing intersects anything else: the smallest distance of each target, taken as a ball, from
// everything else, metres.
constexpr double clearance = 0.05;
constexpr double ground = -0.80, pedestal = 0.12;  // metres: the floor's height, a radius

enum class Place { before, behind, beside };
constexpr std::array<Place, 8> places{Place::before, Place::before, Place::behind, Place::behind,
                                      Place::behind, Place::behind, Place::beside, Place::beside};

/// Every frame has a new arm pose and new positions of the same eight targets, which touch neither
/// the arm nor one another. With `carries` the arm also holds an object.
class RandomTargets : public Scene {
 public:
  RandomTargets(Arm& arm, const SceneOptions& options, const Intrinsics& intrinsics, bool carries);
  [[nodiscard]] std::vector<double> joints(double time) const override;
  [[nodiscard]] ScenePose pose(double time) override;

 private:
  void add_held(Random random);
  [[nodiscard]] std::uint64_t index(double time) const;
  /// The occupied space: the arm, and balls around targets.
  struct Taken {
    std::vector<Arm::PartBox> parts;
    std::vector<std::pair<Vector3d, double>> balls;
  };
  [[nodiscard]] bool is_free(const Vector3d& at, double radius, const Taken& taken) const;
  [[nodiscard]] Vector3d position(Place place, double radius, Random& random,
                                  const std::vector<Vector3d>& parts, const Taken& taken) const;

  Arm& arm_;
  std::uint64_t seed_;
  double frame_rate_;
  Intrinsics intrinsics_;
  std::vector<double> radii_;  // of balls around the targets
  std::optional<Isometry3d> T_tool_held_;
  double held_radius_ = 0.0;
};

RandomTargets::RandomTargets(Arm& arm, const SceneOptions& options, const Intrinsics& intrinsics,
                             bool carries)
    : arm_(arm), seed_(options.seed), frame_rate_(options.frame_rate), intrinsics_(intrinsics) {
  Random random(seed_, 12);
  description_.moves = false;
  const double around = random.uniform(-2.2, -0.6);
  const double far =
      random.uniform(1.3, 1.7) + (arm.robot().links().front() == "world" ? 0.5 : 0.0);
  const double height = random.uniform(0.4, 1.0);
  const auto camera = [&](double angle) {
    return look_at({far * std::cos(angle), far * std::sin(angle), height}, {0.0, 0.0, 0.40});
  };
  description_.T_base_camera = camera(around);
  description_.T_base_second_camera = camera(around + 2.0);
  description_.duration = frames / frame_rate_;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Vector3d half, color;
    for (double& side : half) side = random.uniform(0.015, 0.06);
    for (double& part : color) part = random.uniform(0.2, 0.9);
    const bool ball = random.uniform() < 0.4;
    const std::string size = ball ? numbers({half.x()}) : numbers({half.x(), half.y(), half.z()});
    description_.parts.push_back(
        {static_cast<int>(i),
         std::string("<geom type=\"") + (ball ? "sphere" : "box") + "\" size=\"" + size +
             "\" rgba=\"" + numbers({color.x(), color.y(), color.z(), 1.0}) + "\" group=\"2\"/>"});
    description_.objects.push_back("target_" + std::to_string(i));
    description_.solids.push_back({ball ? Solid::ball : Solid::box,
                                   2 * (ball ? Vector3d(half.x(), half.x(), half.x()) : half)});
    radii_.push_back(ball ? half.x() : half.norm());
  }
  std::string room =
      "<geom type=\"box\" size=\"5 5 0.05\" pos=\"0 0 -0.85\" rgba=\"0.62 0.62 0.6 1\" "
      "group=\"2\"/><geom type=\"cylinder\" size=\"0.12 0.4\" pos=\"0 0 -0.4\" "
      "rgba=\"0.3 0.3 0.32 1\" group=\"2\"/>";
  for (const auto& [x, y] : {std::pair(4.0, 0.0), {-4.0, 0.0}, {0.0, 4.0}, {0.0, -4.0}})
    room += "<geom type=\"box\" size=\"" +
            numbers({x == 0.0 ? 5.0 : 0.05, y == 0.0 ? 5.0 : 0.05, 3.0}) + "\" pos=\"" +
            numbers({x, y, 2.0}) + "\" rgba=\"0.8 0.81 0.78 1\" group=\"2\"/>";
  description_.parts.push_back({-1, room});
  if (carries) add_held(Random(seed_, 15));
}

/// A box in the gripper or, for odd seeds, the half of it on one side of a diagonal plane.
void RandomTargets::add_held(Random random) {
  Vector3d half;
  for (double& side : half) side = random.uniform(0.03, 0.08);
  held_radius_ = half.norm();
  std::string geom = "<geom type=\"box\" size=\"" + numbers({half.x(), half.y(), half.z()}) + "\"";
  if (seed_ % 2 == 1) {
    std::string corners;
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {-1.0, 1.0}})
      for (const double z : {-1.0, 1.0})
        corners += numbers({x * half.x(), y * half.y(), z * half.z()}) + ' ';
    description_.assets += "<mesh name=\"held\" vertex=\"" + corners + "\"/>";
    geom = "<geom type=\"mesh\" mesh=\"held\"";
  }
  description_.parts.push_back(
      {static_cast<int>(places.size()), geom + " rgba=\"0.8 0.6 0.2 1\" group=\"2\"/>"});
  description_.objects.push_back("held");
  description_.solids.push_back({seed_ % 2 == 1 ? Solid::wedge : Solid::box, 2 * half});
  T_tool_held_.emplace(Isometry3d::Identity());
  T_tool_held_->translation() = Vector3d(0.0, 0.0, half.z() + random.uniform(-0.03, 0.0));
  T_tool_held_->linear() =
      Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Vector3d::UnitZ()).toRotationMatrix();
}

std::uint64_t RandomTargets::index(double time) const {
  return static_cast<std::uint64_t>(std::llround(std::max(0.0, time) * frame_rate_));
}

std::vector<double> RandomTargets::joints(double time) const {
  Random random(seed_, mix(index(time)) ^ 13);
  std::vector<double> positions = arm_.robot().rest_positions();
  for (const Joint& joint : arm_.robot().joints()) {
    if (!joint.variable || joint.mimics) continue;
    // Wrists turn fully, but the arm keeps away from its own base.
    const double most = joint.name.ends_with("shoulder_lift") ? 1.4
                        : joint.name.ends_with("elbow")       ? 2.2
                                                              : 3.0;
    positions[*joint.variable] = random.uniform(std::max(joint.lower.value_or(-most), -most),
                                                std::min(joint.upper.value_or(most), most));
  }
  return positions;
}

bool RandomTargets::is_free(const Vector3d& at, double radius, const Taken& taken) const {
  const double least = radius + clearance;
  if (at.z() < ground + least) return false;
  if (at.z() < least && at.head<2>().norm() < pedestal + least) return false;
  return std::none_of(taken.parts.begin(), taken.parts.end(),
                      [&](const Arm::PartBox& part) { return part.distance(at) < least; }) &&
         std::none_of(taken.balls.begin(), taken.balls.end(), [&](const auto& ball) {
           return (ball.first - at).norm() < ball.second + least;
         });
}

/// Returns a position near the ray through one of the arm's parts, at a depth for `place`, apart
/// from everything.
Vector3d RandomTargets::position(Place place, double radius, Random& random,
                                 const std::vector<Vector3d>& parts, const Taken& taken) const {
  constexpr int attempts = 1000;
  const Isometry3d T_camera_base = description_.T_base_camera.inverse();
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const auto chosen =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(parts.size()));
    const Vector3d part = T_camera_base * parts[chosen];
    if (part.z() < nearest_target) continue;
    double depth = part.z();
    if (place == Place::before) depth -= gap + radius + random.uniform(0.05, 0.35);
    if (place == Place::behind) depth += gap + radius + random.uniform(0.05, 0.60);
    if (depth - radius < nearest_target) continue;
    const double least = place == Place::beside ? 0.12 + radius : 0.0;
    const double aside = random.uniform(least, least + 0.12);
    const double angle = random.uniform(0.0, 6.2831853);
    const Vector3d at =
        part * (depth / part.z()) + aside * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector2d pixel = intrinsics_.project(at);
    if (pixel.x() > 0 && pixel.y() > 0 && pixel.x() < intrinsics_.width() &&
        pixel.y() < intrinsics_.height() && is_free(description_.T_base_camera * at, radius, taken))
      return description_.T_base_camera * at;
  }
  // There is no room in the view, so the target is placed behind the camera.
  return description_.T_base_camera *
         Vector3d(0.0, 0.0, -1.0 - 0.5 * static_cast<double>(taken.balls.size()));
}

ScenePose RandomTargets::pose(double time) {
  Random random(seed_, mix(index(time)) ^ 14);
  const std::vector<double> positions = joints(time);
  const std::vector<Vector3d> parts = arm_.part_centres(positions);
  Taken taken{arm_.part_boxes(positions), {}};
  std::optional<Isometry3d> held;
  if (T_tool_held_) {
    held = arm_.link_pose(positions, tool_link) * *T_tool_held_;
    taken.balls.emplace_back(held->translation(), held_radius_);
  }
  ScenePose all;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Isometry3d target = Isometry3d::Identity();
    target.translation() = position(places[i], radii_[i], random, parts, taken);
    taken.balls.emplace_back(target.translation(), radii_[i]);
    Eigen::Vector4d turn;
    for (double& x : turn) x = random.normal();
    target.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
    all.parts.push_back(target);
    all.objects.push_back(target);
  }
  all.parts.push_back(Isometry3d::Identity());
  if (held) {
    all.parts.push_back(*held);
    all.objects.push_back(*held);
  }
  return all;
}

}  // namespace

std::unique_ptr<Scene> make_random_targets(Arm& arm, const SceneOptions& options,
                                           const Intrinsics& intrinsics, bool carries) {
  return std::make_unique<RandomTargets>(arm, options, intrinsics, carries);
}

}  // namespace penumbra::sim
