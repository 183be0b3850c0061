// SPDX-License-Identifier: Apache-2.0
// Cameras and boxes at random places, and what rays say the robot hides of them.
#pragma once

#include "link_rays.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra::test {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Camera forecast_camera() {
  return {Intrinsics(640, 480, 600, 600, 319.5, 239.5), {}, {}, {}};
}

inline Eigen::Isometry3d looking_at(const Eigen::Vector3d& from, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - from).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = from;
  return T;
}

/// A ray of the camera that meets a target, and the depth where it does.
struct TargetRay {
  Eigen::Vector3d direction;  // in the root's frame; z is 1 in the camera's
  double z;
};

inline std::vector<TargetRay> rays_of(const BoxTarget& box, const Eigen::Isometry3d& T_root_camera,
                                      const Intrinsics& camera) {
  std::vector<TargetRay> rays;
  const Eigen::Isometry3d T_box_camera = box.pose.inverse() * T_root_camera;
  const Eigen::Array3d half = 0.5 * box.size.array();
  const Eigen::Array3d from = T_box_camera.translation().array();
  for (int v = 0; v < camera.height(); ++v)
    for (int u = 0; u < camera.width(); ++u) {
      const Eigen::Array3d d = (T_box_camera.linear() * camera.ray(u, v)).array();
      const Eigen::Array3d a = (-half - from) / d, b = (half - from) / d;
      const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
      if (in <= out && in > 0.0) rays.push_back({T_root_camera.linear() * camera.ray(u, v), in});
    }
  return rays;
}

/// What Embree's rays say of a target.
struct Truth {
  double hidden = 0.0;
  std::size_t by = 0;  // link
};

inline Truth truth_of(const std::vector<TargetRay>& rays, const LinkRays& links,
                      const Eigen::Vector3d& from, const Tolerance& tolerance) {
  std::map<std::size_t, std::size_t> hiding;
  std::size_t hidden = 0;
  for (const TargetRay& ray : rays)
    if (const auto hit = links.cast(from, ray.direction, ray.z - tolerance.at(ray.z))) {
      ++hidden;
      ++hiding[hit->link];
    }
  const auto most =
      std::ranges::max_element(hiding, {}, [](const auto& each) { return each.second; });
  return {static_cast<double>(hidden) / static_cast<double>(rays.size()),
          most == hiding.end() ? 0 : most->first};
}

}  // namespace penumbra::test
