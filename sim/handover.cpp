// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <sim/random.hpp>
#include <sim/scene.hpp>
#include <sim/spline.hpp>

namespace penumbra::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double handover_time = 8.0;  // seconds

// A person's dimensions in metres; z = 0 is the table's top, 0.75 m above the floor.
constexpr double upper_arm = 0.30, forearm = 0.27, palm = 0.09;
constexpr double wrist_radius = 0.036;
const Vector3d shoulder_of_body(0.0, 0.20, 0.50);
const Vector3d arm_in_the_back(0.60, 0.02, 0.31);  // the tool while the hand is in front of it
const Vector3d usual_wrist(0.64, 0.20, 0.30), usual_body(1.10, 0.06, 0.0);

enum Object { wrist, hand, person };

struct Limb {
  int object;
  double radius, length;
  const char* color;
};

// In the order of Handover::limbs().
constexpr std::array<Limb, 10> limb_kinds{{{person, 0.040, upper_arm, "0.20 0.30 0.52 1"},
                                           {person, 0.031, forearm, "0.20 0.30 0.52 1"},
                                           {wrist, wrist_radius, 0.0, "0.85 0.64 0.52 1"},
                                           {hand, 0.024, palm, "0.85 0.64 0.52 1"},
                                           {hand, 0.011, 0.07, "0.85 0.64 0.52 1"},
                                           {hand, 0.011, 0.07, "0.85 0.64 0.52 1"},
                                           {hand, 0.013, 0.06, "0.85 0.64 0.52 1"},
                                           {person, 0.150, 0.42, "0.20 0.30 0.52 1"},
                                           {person, 0.040, upper_arm + 0.15, "0.20 0.30 0.52 1"},
                                           {person, 0.120, 0.60, "0.25 0.25 0.28 1"}}};

/// Returns the pose of a capsule from one end's centre towards another point.
Isometry3d along(const Vector3d& from, const Vector3d& towards) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), towards - from).toRotationMatrix();
  pose.translation() = from;
  return pose;
}

class Handover : public Scene {
 public:
  Handover(Arm& arm, const SceneOptions& options);
  [[nodiscard]] std::vector<double> joints(double time) const override;
  [[nodiscard]] ScenePose pose(double time) override;

 private:
  void dress();
  void plan_hand(Random& random);
  void plan_arm(Arm& arm, Random& random);
  [[nodiscard]] std::vector<Isometry3d> limbs(double time) const;
  [[nodiscard]] Vector3d wrist_at(double time) const { return hand_path_.front().at(time); }

  std::vector<Spline> hand_path_, arm_path_;  // each has one element: a spline has no empty state
};

Handover::Handover(Arm& arm, const SceneOptions& options) {
  Random random(options.seed, 13);
  const double eye_x = random.uniform(0.38, 0.52), eye_z = random.uniform(0.48, 0.66);
  description_.T_base_camera = look_at({eye_x, -1.45, eye_z}, {0.56, 0.0, 0.28});
  description_.T_base_second_camera = look_at({0.10, 1.35, 0.75}, {0.60, 0.05, 0.28});
  description_.duration = handover_time;
  description_.objects = {"wrist", "hand", "person"};
  dress();
  plan_hand(random);
  plan_arm(arm, random);
}

void Handover::dress() {
  for (const Limb& limb : limb_kinds) {
    std::string geom = limb.length == 0.0
                           ? "<geom type=\"sphere\" size=\"" + numbers({limb.radius})
                           : "<geom type=\"capsule\" size=\"" + numbers({limb.radius}) +
                                 "\" fromto=\"" + numbers({0, 0, 0, 0, 0, limb.length});
    geom += std::string("\" rgba=\"") + limb.color + "\" group=\"2\"/>";
    description_.parts.push_back({limb.object, std::move(geom)});
  }
  description_.parts.push_back(
      {person,
       "<geom type=\"ellipsoid\" size=\"0.095 0.08 0.125\" rgba=\"0.85 0.64 0.52 1\" "
       "group=\"2\"/><geom type=\"ellipsoid\" size=\"0.1 0.085 0.09\" pos=\"0.015 0 0.05\" "
       "rgba=\"0.22 0.16 0.12 1\" group=\"2\"/>"});
  description_.parts.push_back(
      {-1,
       "<geom type=\"box\" size=\"0.48 0.5 0.02\" pos=\"0.3 0 -0.02\" rgba=\"0.72 0.6 0.45 1\" "
       "group=\"2\"/><geom type=\"box\" size=\"4 4 0.05\" pos=\"0 0 -0.80\" "
       "rgba=\"0.6 0.6 0.58 1\" group=\"2\"/><geom type=\"box\" size=\"4 0.05 2\" "
       "pos=\"0 1.7 1\" rgba=\"0.82 0.83 0.80 1\" group=\"2\"/>"});
}

/// Plans the hand: it waits behind the arm's plane, moves in front of the arm and back.
void Handover::plan_hand(Random& random) {
  const auto near = [&](const Vector3d& place, double spread) -> Eigen::VectorXd {
    Vector3d p = place;
    for (double& x : p) x += random.uniform(-spread, spread);
    return p;
  };
  // Between the camera and the arm's hand.
  const Vector3d eye = description_.T_base_camera.translation();
  const Vector3d front = eye + 0.73 * (arm_in_the_back - 0.09 * Vector3d::UnitX() - eye);
  const Vector3d drift{random.uniform(-0.05, 0.0), 0.0, random.uniform(-0.03, 0.03)};
  const Eigen::VectorXd first = near({0.66, 0.20, 0.30}, 0.03);
  const Eigen::VectorXd last = near({0.60, 0.14, 0.30}, 0.02);
  hand_path_.emplace_back(std::vector<Knot>{{0.0, first + Eigen::VectorXd(near({0.1, 0, 0}, 0.03))},
                                            {1.0, first},
                                            {2.2, first + 0.6 * drift},
                                            {3.4, first + drift},
                                            {4.2, near({0.74, -0.10, 0.40}, 0.02)},
                                            {4.9, near(front, 0.015)},
                                            {5.5, near(front, 0.015)},
                                            {6.3, near({0.72, -0.05, 0.38}, 0.02)},
                                            {7.0, last},
                                            {handover_time, last + 0.3 * drift}});
}

void Handover::plan_arm(Arm& arm, Random& random) {
  const Vector3d eye = description_.T_base_camera.translation(), up = Vector3d::UnitZ();
  const auto between = [&](double time, double offset) {
    const Vector3d target = wrist_at(time);
    const Vector3d p = target + 0.19 * (eye - target);
    const Vector3d ahead = Vector3d(1.0, 0.15, -0.25).normalized();
    return tool_pose(p + 0.10 * ahead + offset * up, ahead, up.cross(ahead));
  };
  const auto at = [&](const Vector3d& p, const Vector3d& ahead) {
    return tool_pose(p, ahead, up.cross(ahead));
  };
  const Isometry3d park = at({0.34, -0.16, 0.52}, {0.8, 0.0, -0.6});
  const double early = random.uniform(0.9, 1.2);
  const std::vector<std::pair<double, Isometry3d>> goals = {
      {early, park},
      {early + 0.9, between(early + 0.9, 0.02)},
      {early + 1.3, between(early + 1.3, 0.0)},
      {early + 1.7, between(early + 1.7, random.uniform(-0.02, 0.02))},
      {4.0, park},
      {4.8, at(arm_in_the_back, {1.0, 0.0, -0.2})},
      {5.2, at(arm_in_the_back, {1.0, 0.0, -0.2})},
      {5.6, at(arm_in_the_back, {1.0, 0.0, -0.2})},
      {6.3, park},
      {7.2, between(7.2, 0.0)},
      {7.6, between(7.6, 0.0)},
      {handover_time, between(handover_time, 0.0)}};
  std::vector<double> positions = {-0.3, 0.0, 1.2, 0.0, -1.57, 0.0, 0.02};
  std::vector<Knot> knots;
  for (const auto& [time, goal] : goals) {
    positions = arm.reach(goal, tool_link, positions);
    positions.back() = 0.035;
    knots.push_back({time, as_vector(positions)});
  }
  arm_path_.emplace_back(std::move(knots));
}

std::vector<double> Handover::joints(double time) const {
  const Eigen::VectorXd value = arm_path_.front().at(time);
  return {value.begin(), value.end()};
}

/// Returns the elbow of two bones, below the line from shoulder to wrist.
Vector3d elbow_of(const Vector3d& shoulder, const Vector3d& wrist_point) {
  const Vector3d line = wrist_point - shoulder;
  const double reach = std::min(line.norm(), 0.999 * (upper_arm + forearm));
  const double x = (reach * reach + upper_arm * upper_arm - forearm * forearm) / (2.0 * reach);
  const double y = std::sqrt(std::max(0.0, upper_arm * upper_arm - x * x));
  const Vector3d ahead = line.normalized();
  Vector3d down(0.0, 0.45, -1.0);
  down = (down - down.dot(ahead) * ahead).normalized();
  return shoulder + x * ahead + y * down;
}

std::vector<Isometry3d> Handover::limbs(double time) const {
  const Vector3d w = wrist_at(time);
  // The person steps and leans after the hand as far as the arm's length requires.
  Vector3d body = usual_body + 0.55 * (w - usual_wrist);
  body.z() = 0.0;
  Vector3d shoulder = body + shoulder_of_body;
  const Vector3d line = w - shoulder;
  const double too_far = line.norm() - 0.98 * (upper_arm + forearm);
  if (too_far > 0.0) {
    body += too_far * line.normalized();
    shoulder = body + shoulder_of_body;
  }
  const Vector3d elbow = elbow_of(shoulder, w);
  const Isometry3d frame = along(w, w + (w - elbow));
  const Vector3d knuckles = frame * Vector3d(0.0, 0.0, palm);
  return {along(shoulder, elbow),
          along(elbow, w),
          frame,
          frame,
          along(knuckles, frame * Vector3d(0.0, 0.014, palm + 0.07)),
          along(knuckles, frame * Vector3d(0.0, -0.014, palm + 0.07)),
          along(frame * Vector3d(0.0, 0.0, 0.03), frame * Vector3d(0.03, 0.03, 0.09)),
          along(body + Vector3d(0.0, 0.0, 0.0), body + Vector3d(0.0, 0.0, 0.42)),
          along(body + Vector3d(0.0, -0.20, 0.48), body + Vector3d(0.02, -0.24, 0.0)),
          along(body + Vector3d(0.0, 0.0, -0.62), body),
          Isometry3d(Eigen::Translation3d(body + Vector3d(-0.02, 0.0, 0.74)))};
}

ScenePose Handover::pose(double time) {
  ScenePose all;
  all.parts = limbs(time);
  const Isometry3d frame = all.parts[2], trunk = all.parts[7];
  all.parts.push_back(Isometry3d::Identity());
  all.objects = {frame, frame, trunk};
  return all;
}

}  // namespace

std::unique_ptr<Scene> make_handover(Arm& arm, const SceneOptions& options) {
  return std::make_unique<Handover>(arm, options);
}

}  // namespace penumbra::sim
