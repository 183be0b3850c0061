// SPDX-License-Identifier: Apache-2.0
// Cameras and boxes at random places, and what rays say the robot hides of them.
#pragma once

#include "../support/data.hpp"
#include "link_rays.hpp"

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra::test {

inline Camera forecast_camera() {
  return {Intrinsics(640, 480, 600, 600, 319.5, 239.5), {}, {}, {}};
}

inline Isometry3d looking_at(const Vector3d& from, const Vector3d& at) {
  const Vector3d z = (at - from).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  Isometry3d T = Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = from;
  return T;
}

/// A camera around a robot's base that looks at it.
inline Isometry3d random_viewpoint(std::mt19937_64& random) {
  const double around = uniform(random, 0.0, 6.28), away = uniform(random, 1.2, 2.2);
  return looking_at({away * std::cos(around), away * std::sin(around), uniform(random, 0.2, 1.2)},
                    {0.0, 0.0, uniform(random, 0.2, 0.5)});
}

inline Vector3d random_offset(std::mt19937_64& random) {
  return {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
}

/// A box of random edges that is turned at random.
inline BoxTarget random_box(std::mt19937_64& random, const Vector3d& at, double least,
                            double most) {
  BoxTarget box{.frame = ReferenceFrame::root()};
  box.pose = Translation3d(at) * AngleAxisd(uniform(random, 0.0, 6.28), Vector3d::UnitZ()) *
             AngleAxisd(uniform(random, 0.0, 6.28), Vector3d::UnitX());
  for (int i = 0; i < 3; ++i) box.size[i] = uniform(random, least, most);
  return box;
}

/// The example's arm and, where the data are, two real ones.
inline std::vector<Robot> arms() {
  std::vector<Robot> robots{
      Robot::load(PENUMBRA_SOURCE_DIR "/examples/arm_over_table/arm_description/arm.urdf")};
  if (has_data())
    for (const std::string name : {"xarm7", "ur5e"})
      robots.push_back(Robot::load(data_folder() / "robots" / name / (name + ".urdf")));
  return robots;
}

/// A ray of the camera that meets a target, and the depth where it does.
struct TargetRay {
  Vector3d direction;  // in the root's frame; z is 1 in the camera's
  double z;
};

inline std::vector<TargetRay> rays_of(const BoxTarget& box, const Isometry3d& T_root_camera,
                                      const Intrinsics& camera) {
  std::vector<TargetRay> rays;
  const Isometry3d T_box_camera = box.pose.inverse() * T_root_camera;
  for (const auto [u, v] : each_pixel(camera)) {
    const Vector3d ray = camera.ray(u, v);
    const auto in =
        enter_box(T_box_camera.translation(), T_box_camera.linear() * ray, box.size / 2);
    if (in && *in > 0.0) rays.push_back({T_root_camera.linear() * ray, *in});
  }
  return rays;
}

/// What Embree's rays say of a target.
struct Truth {
  double hidden = 0.0;
  std::size_t by = 0;  // link
};

inline Truth truth_of(const std::vector<TargetRay>& rays, const LinkRays& links,
                      const Vector3d& from, const Tolerance& tolerance) {
  std::map<std::size_t, std::size_t> hiding;
  std::size_t hidden = 0;
  for (const TargetRay& ray : rays)
    if (const auto hit = links.cast(from, ray.direction, ray.z - tolerance.at(ray.z))) {
      ++hidden;
      ++hiding[hit->link];
    }
  const auto most =
      std::ranges::max_element(hiding, {}, [](const auto& each) { return each.second; });
  return {double(hidden) / double(rays.size()), most == hiding.end() ? 0 : most->first};
}

}  // namespace penumbra::test
