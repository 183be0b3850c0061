// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include <sim/random.hpp>
#include <sim/scene.hpp>
#include <sim/spline.hpp>
#include <sim/texture.hpp>

namespace penumbra::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double belt_x = 0.52;     // metres from the robot's axis to the belt's middle
constexpr double grasp_time = 4.5;  // seconds
constexpr double conveyor_time = 5.0;
constexpr double hand_length = 0.13;  // metres from the tool's point back into the gripper
constexpr int print_width = 320;      // pixels of the object's print

/// Returns a box as a mesh, with the upper half of its texture on the +z face and the lower half on
/// the others.
std::string printed_box(const Vector3d& size) {
  std::string vertices, coordinates, faces;
  int count = 0;
  const Vector3d half = 0.5 * size;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const bool front = axis == 2 && side > 0.0;
      constexpr std::array<std::pair<double, double>, 4> corners{
          {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}};
      for (const auto& [ca, cb] : corners) {
        Vector3d p;
        p[axis] = side * half[axis];
        p[a] = ca * half[a];
        p[b] = cb * half[b];
        vertices += numbers({p.x(), p.y(), p.z()}) + ' ';
        // The print's rows run along -y, its columns along +x.
        const double s = 0.5 + 0.5 * ca, t = 0.25 - 0.25 * cb;
        coordinates += numbers({s, front ? t : t + 0.5}) + ' ';
      }
      const std::array<int, 6> order =
          side > 0.0 ? std::array<int, 6>{0, 1, 2, 0, 2, 3} : std::array<int, 6>{0, 2, 1, 0, 3, 2};
      for (const int k : order) faces += std::to_string(count + k) + ' ';
      count += 4;
    }
  return "<mesh name=\"parcel\" vertex=\"" + vertices + "\" texcoord=\"" + coordinates +
         "\" face=\"" + faces + "\"/>";
}

class Conveyor : public Scene {
 public:
  Conveyor(Arm& arm, const SceneOptions& options);
  [[nodiscard]] std::vector<double> joints(double time) const override;
  [[nodiscard]] ScenePose pose(double time) override;

 private:
  [[nodiscard]] Isometry3d object(double time) const;
  void dress(Random& random);
  void plan(Arm& arm, Random& random);

  Vector3d direction_, at_grasp_, size_;
  double speed_ = 0.0, yaw_ = 0.0;  // m/s, rad
  double jitter_ = 0.0;             // jitter of the speed, relative
  std::array<double, 3> phases_{};
  std::vector<Spline> path_;  // has one element: a spline has no empty state
};

Conveyor::Conveyor(Arm& arm, const SceneOptions& options) : jitter_(options.belt_jitter) {
  Random random(options.seed, 11);
  const double heading = random.uniform(-0.12, 0.12), side = random.sign();
  direction_ = Vector3d(std::sin(heading), side * std::cos(heading), 0.0);
  speed_ = random.uniform(0.07, 0.105);
  size_ = {random.uniform(0.11, 0.13), random.uniform(0.08, 0.10), random.uniform(0.05, 0.07)};
  yaw_ = random.uniform(-3.1415926, 3.1415926);
  at_grasp_ = Vector3d(belt_x, side * random.uniform(0.04, 0.14), 0.5 * size_.z());
  for (double& phase : phases_) phase = random.uniform(0.0, 6.2831853);
  const double eye_y = random.uniform(-0.06, 0.06);
  description_.T_base_camera = look_at({1.06, eye_y, 0.78}, {0.49, 0.0, 0.06});
  description_.T_base_second_camera = look_at({0.60, -side * 1.05, 0.80}, {0.50, 0.0, 0.04});
  description_.duration = conveyor_time;
  description_.grasp = grasp_time;
  description_.object_size = size_;
  description_.conveyor_direction = direction_;
  dress(random);
  plan(arm, random);
}

void Conveyor::dress(Random& random) {
  const int rows = static_cast<int>(std::lround(print_width * size_.y() / size_.x()));
  description_.model_image = busy_print(print_width, rows, random);
  const Image<Rgb8> card = grain(print_width, rows, {176, 140, 98}, 14, random);
  Image<Rgb8> both(print_width, 2 * rows);
  std::copy_n(description_.model_image.data(), card.size(), both.data());
  std::copy_n(card.data(), card.size(), both.data() + card.size());
  description_.textures.push_back({"print", std::move(both)});
  // The surroundings are plain, because they fill most of the image and textures cost a third of
  // its time.
  description_.assets = "<texture name=\"print\" type=\"2d\" builtin=\"flat\" width=\"" +
                        std::to_string(print_width) + "\" height=\"" + std::to_string(2 * rows) +
                        "\"/><material name=\"print\" texture=\"print\" specular=\"0\"/>" +
                        printed_box(size_);
  description_.objects = {"parcel"};
  description_.parts = {
      {0, "<geom type=\"mesh\" mesh=\"parcel\" material=\"print\" group=\"2\"/>"},
      {-1,
       "<geom type=\"box\" size=\"0.19 1.2 0.02\" pos=\"0 0 -0.02\" rgba=\"0.24 0.25 0.27 1\" "
       "group=\"2\"/>"},
      {-1,
       "<geom type=\"box\" size=\"3 3 0.05\" pos=\"0 0 -0.10\" rgba=\"0.62 0.62 0.6 1\" "
       "group=\"2\"/>"}};
}

Isometry3d Conveyor::object(double time) const {
  // The belt's speed varies about its mean. The displacement is its integral, and at the grasp the
  // object is where the arm expects it.
  const auto displacement = [&](double t) {
    double wander = 0.0;
    for (std::size_t k = 0; k < phases_.size(); ++k) {
      const double omega = 2.1 + 1.7 * static_cast<double>(k);
      wander += (std::sin(omega * t + phases_[k]) - std::sin(phases_[k])) / omega;
    }
    return speed_ * (t + jitter_ * std::sqrt(2.0 / 3.0) * wander);
  };
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = at_grasp_ + (displacement(time) - displacement(grasp_time)) * direction_;
  pose.linear() = Eigen::AngleAxisd(yaw_, Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

void Conveyor::plan(Arm& arm, Random& random) {
  const double side = direction_.y() > 0.0 ? 1.0 : -1.0;
  const Vector3d eye = description_.T_base_camera.translation(), down = -Vector3d::UnitZ();
  const Vector3d across = Vector3d::UnitY();
  const auto before = [&](double time, double share, double offset) {
    const Vector3d o = object(time).translation();
    const Vector3d p = o + share * (eye - o) + Vector3d(0.0, offset, 0.0);
    const Vector3d out = Vector3d(p.x(), p.y(), 0.0).normalized();
    const Vector3d ahead = (out + 0.9 * down).normalized();
    // The hand, not the fingertips, comes in front of the object.
    return tool_pose(p + hand_length * ahead, ahead, Vector3d::UnitZ().cross(out));
  };
  const auto above = [&](double time, double height) {
    return tool_pose(object(time).translation() + Vector3d(0.0, 0.0, 0.5 * size_.z() + height),
                     down, across);
  };
  const Isometry3d park = tool_pose(Vector3d(0.28, side * random.uniform(0.38, 0.46), 0.42),
                                    Vector3d(0.3, side * 0.5, -1.0), across);
  // Some grasps directly follow the hidden interval; before others the object is visible again.
  const bool emerges = random.uniform() < 0.5;
  const double share = random.uniform(0.28, 0.38), start = random.uniform(1.2, 1.6);
  std::vector<std::pair<double, Isometry3d>> goals = {
      {start, park},
      {start + 0.7, before(start + 0.7, share, side * random.uniform(0.16, 0.24))},
      {start + 1.15, before(start + 1.15, share, 0.0)},
      {start + 1.6, before(start + 1.6, share, -side * random.uniform(-0.02, 0.05))},
  };
  if (emerges) goals.emplace_back(3.6, before(3.6, 0.15, -side * 0.26));
  goals.emplace_back(4.1, above(4.1, 0.12));
  goals.emplace_back(grasp_time, above(grasp_time, -0.015));
  goals.emplace_back(conveyor_time, above(grasp_time, 0.14));
  std::vector<double> positions = {side * 0.9, 0.1, 1.4, 0.1, -1.57, 0.0, 0.03};
  std::vector<Knot> knots;
  for (const auto& [time, goal] : goals) {
    positions = arm.reach(goal, tool_link, positions);
    positions.back() = time < grasp_time ? 0.04 : 0.02;
    knots.push_back({time, as_vector(positions)});
  }
  path_.emplace_back(std::move(knots));
}

std::vector<double> Conveyor::joints(double time) const {
  const Eigen::VectorXd value = path_.front().at(time);
  return {value.begin(), value.end()};
}

ScenePose Conveyor::pose(double time) {
  ScenePose all;
  const Isometry3d parcel = object(time);
  Isometry3d belt = Isometry3d::Identity();
  belt.translation() = Vector3d(belt_x, 0.0, 0.0);
  belt.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), direction_).toRotationMatrix();
  if (direction_.y() < 0.0)
    belt.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), -direction_).toRotationMatrix();
  all.parts = {parcel, belt, Isometry3d::Identity()};
  all.objects = {parcel};
  return all;
}

}  // namespace

std::unique_ptr<Scene> make_conveyor(Arm& arm, const SceneOptions& options) {
  return std::make_unique<Conveyor>(arm, options);
}

}  // namespace penumbra::sim
