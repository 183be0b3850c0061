// SPDX-License-Identifier: Apache-2.0
// Cameras and boxes at random places, and what rays say the robot hides of them.
#pragma once

#include "../support/data.hpp"
#include "../support/test.hpp"

#include <embree3/rtcore.h>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra::test {

inline Camera forecast_camera() {
  return {Intrinsics(640, 480, 600, 600, 319.5, 239.5), {}, {}, {}};
}

/// A camera around a robot's base that looks at it.
inline Isometry3d random_viewpoint(std::mt19937_64& random) {
  const double around = uniform(random, 0.0, 6.28), away = uniform(random, 1.2, 2.2);
  return looking_at({away * std::cos(around), away * std::sin(around), uniform(random, 0.2, 1.2)},
                    {0.0, 0.0, uniform(random, 0.2, 0.5)});
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

/// Casts rays at a robot that moves, with Embree: each link is an instance.
class LinkRays {
 public:
  explicit LinkRays(const Robot& robot) {
    if (device_ == nullptr) throw std::runtime_error("Embree makes no device");
    world_ = rtcNewScene(device_);
    rtcSetSceneFlags(world_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    for (std::size_t link = 0; link < robot.links().size(); ++link)
      if (!robot.meshes(link).empty()) add(robot, link);
  }
  ~LinkRays() {
    for (const RTCScene each : meshes_) rtcReleaseScene(each);
    for (const RTCGeometry each : instances_) rtcReleaseGeometry(each);
    rtcReleaseScene(world_);
    rtcReleaseDevice(device_);
  }
  LinkRays(const LinkRays&) = delete;
  LinkRays& operator=(const LinkRays&) = delete;

  void place(std::span<const Isometry3d> T_root_link) {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      const Eigen::Matrix4f T = T_root_link[links_[i]].matrix().cast<float>();
      rtcSetGeometryTransform(instances_[i], 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, T.data());
      rtcCommitGeometry(instances_[i]);
    }
    rtcCommitScene(world_);
  }

  /// The first surface on a ray from `from` before `most` lengths of `direction`.
  struct Hit {
    double at;         ///< in lengths of the direction
    std::size_t link;  ///< index
  };
  [[nodiscard]] std::optional<Hit> cast(const Vector3d& from, const Vector3d& direction,
                                        double most) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    const Vector3f o = from.cast<float>(), d = direction.cast<float>();
    ray.ray = {.org_x = o.x(),
               .org_y = o.y(),
               .org_z = o.z(),
               .tnear = 0.01F,  // the near plane
               .dir_x = d.x(),
               .dir_y = d.y(),
               .dir_z = d.z(),
               .time = 0.0F,
               .tfar = float(most),
               .mask = ~0U,
               .id = 0,
               .flags = 0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(world_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{ray.ray.tfar, links_[ray.hit.instID[0]]};
  }

 private:
  void add(const Robot& robot, std::size_t link) {
    const RTCScene scene = meshes_.emplace_back(rtcNewScene(device_));
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (const TriangleMesh& mesh : robot.meshes(link)) {
      const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* const vertices = static_cast<float*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                  3 * sizeof(float), mesh.vertices.size()));
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        Eigen::Map<Vector3f>(vertices + 3 * i) = mesh.vertices[i];
      auto* const indices = static_cast<unsigned*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                  3 * sizeof(unsigned), mesh.triangles.size()));
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) indices[3 * i + k] = mesh.triangles[i][k];
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    const RTCGeometry instance =
        instances_.emplace_back(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance, scene);
    rtcAttachGeometryByID(world_, instance, static_cast<unsigned>(links_.size()));
    links_.push_back(link);
  }

  RTCDevice device_ = rtcNewDevice("threads=1");
  RTCScene world_ = nullptr;
  std::vector<RTCScene> meshes_;
  std::vector<RTCGeometry> instances_;
  std::vector<std::size_t> links_;  // of the instances
};

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
