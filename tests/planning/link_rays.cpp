// SPDX-License-Identifier: Apache-2.0
#include "link_rays.hpp"

#include <embree3/rtcore.h>

namespace penumbra::test {

struct LinkRays::Scene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene world = nullptr;
  std::vector<RTCScene> meshes;
  std::vector<RTCGeometry> instances;
  std::vector<std::size_t> links;  // of the instances

  Scene() {
    if (device == nullptr) throw std::runtime_error("Embree makes no device");
    world = rtcNewScene(device);
    rtcSetSceneFlags(world, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  }
  ~Scene() {
    for (const RTCScene each : meshes) rtcReleaseScene(each);
    for (const RTCGeometry each : instances) rtcReleaseGeometry(each);
    rtcReleaseScene(world);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void add(const Robot& robot, std::size_t link) {
    const RTCScene scene = meshes.emplace_back(rtcNewScene(device));
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (const TriangleMesh& mesh : robot.meshes(link)) {
      const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
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
        instances.emplace_back(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance, scene);
    rtcAttachGeometryByID(world, instance, static_cast<unsigned>(links.size()));
    links.push_back(link);
  }
};

LinkRays::LinkRays(const Robot& robot) : scene_(std::make_unique<Scene>()) {
  for (std::size_t link = 0; link < robot.links().size(); ++link)
    if (!robot.meshes(link).empty()) scene_->add(robot, link);
}
LinkRays::~LinkRays() = default;

void LinkRays::place(std::span<const Isometry3d> T_root_link) {
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    const Eigen::Matrix4f T = T_root_link[scene_->links[i]].matrix().cast<float>();
    rtcSetGeometryTransform(scene_->instances[i], 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, T.data());
    rtcCommitGeometry(scene_->instances[i]);
  }
  rtcCommitScene(scene_->world);
}

std::optional<LinkRays::Hit> LinkRays::cast(const Vector3d& from, const Vector3d& direction,
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
  rtcIntersect1(scene_->world, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{ray.ray.tfar, scene_->links[ray.hit.instID[0]]};
}

}  // namespace penumbra::test
