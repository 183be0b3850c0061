// SPDX-License-Identifier: Apache-2.0
#include "embree_oracle.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include <embree3/rtcore.h>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

/// Depth of the triangle's plane on the ray, clamped to the range of the triangle's corners.
RayHit exact_hit(const Corners& corners, std::size_t body, const Vector3d& direction) {
  const auto& [a, b, c] = corners;
  const Vector3d normal = (b - a).cross(c - a);
  const Vector3d inverse_depth = normal / normal.dot(a);
  const auto [low, high] = std::minmax({a.z(), b.z(), c.z()});
  return {std::clamp(1.0 / inverse_depth.dot(direction), low, high), body, inverse_depth};
}

/// Collects the triangles that a ray hits, and continues the ray.
struct Collector {
  RTCIntersectContext context;  // Embree is given this member, and gives it back
  std::vector<std::pair<unsigned, unsigned>> hits;  // geometry, triangle

  Collector() {
    rtcInitIntersectContext(&context);
    context.filter = [](const RTCFilterFunctionNArguments* arguments) {
      auto* const self = reinterpret_cast<Collector*>(arguments->context);
      self->hits.emplace_back(RTCHitN_geomID(arguments->hit, arguments->N, 0),
                              RTCHitN_primID(arguments->hit, arguments->N, 0));
      arguments->valid[0] = 0;
    };
  }
};
static_assert(std::is_standard_layout_v<Collector>);

}  // namespace

struct EmbreeOracle::Scene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;
  std::vector<std::vector<Corners>> triangles;  // per Embree geometry, optical frame
  std::vector<std::size_t> bodies;              // per Embree geometry

  Scene() {
    if (device == nullptr) throw std::runtime_error("Embree makes no device");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  }
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void add(const TriangleMesh& mesh, const Eigen::Isometry3d& T_camera_body, std::size_t body) {
    std::vector<Vector3d> points;
    points.reserve(mesh.vertices.size());
    for (const auto& vertex : mesh.vertices)
      points.push_back(T_camera_body * vertex.cast<double>());
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      Eigen::Map<Eigen::Vector3f>(vertices + 3 * i) = points[i].cast<float>();
    auto* const indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    std::vector<Corners>& corners = triangles.emplace_back();
    corners.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      std::copy_n(mesh.triangles[i].begin(), 3, indices + 3 * i);
      corners.push_back({points[a], points[b], points[c]});
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(bodies.size()));
    rtcReleaseGeometry(geometry);
    bodies.push_back(body);
  }

  [[nodiscard]] RTCRayHit cast(const Vector3d& direction, double from_z) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return cast(direction, from_z, std::numeric_limits<double>::infinity(), context);
  }

  [[nodiscard]] RTCRayHit cast(const Vector3d& direction, double from_z, double to_z,
                               RTCIntersectContext& context) const {
    RTCRayHit ray{};
    ray.ray.dir_x = float(direction.x());
    ray.ray.dir_y = float(direction.y());
    ray.ray.dir_z = float(direction.z());
    ray.ray.tnear = float(from_z);
    ray.ray.tfar = float(to_z);
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &ray);
    return ray;
  }
};

EmbreeOracle::EmbreeOracle(std::span<const Body> bodies,
                           std::span<const Eigen::Isometry3d> T_camera_body)
    : scene_(std::make_unique<Scene>()) {
  for (std::size_t body = 0; body < bodies.size(); ++body)
    for (const TriangleMesh& mesh : bodies[body].meshes)
      if (!mesh.triangles.empty()) scene_->add(mesh, T_camera_body[body], body);
  rtcCommitScene(scene_->scene);
}

EmbreeOracle::~EmbreeOracle() = default;
EmbreeOracle::EmbreeOracle(EmbreeOracle&&) noexcept = default;
EmbreeOracle& EmbreeOracle::operator=(EmbreeOracle&&) noexcept = default;

std::optional<RayHit> EmbreeOracle::first_hit(const Vector3d& direction, double from_z) const {
  const RTCRayHit ray = scene_->cast(direction, from_z);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return exact_hit(scene_->triangles[ray.hit.geomID][ray.hit.primID],
                   scene_->bodies[ray.hit.geomID], direction);
}

std::vector<RayHit> EmbreeOracle::all_hits(const Vector3d& direction, double from_z,
                                           double to_z) const {
  Collector collector;
  // Single precision: a little more on both sides, so that equal depths are all found.
  constexpr double more = 1e-6;
  static_cast<void>(
      scene_->cast(direction, from_z * (1 - more), to_z * (1 + more), collector.context));
  std::vector<RayHit> hits;
  for (const auto& [geometry, triangle] : collector.hits)
    hits.push_back(
        exact_hit(scene_->triangles[geometry][triangle], scene_->bodies[geometry], direction));
  return hits;
}

bool EmbreeOracle::camera_is_inside() const {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Vector3d direction(0.31, -0.27, 0.13);  // along no face of a box
      direction[axis] += sign;
      const RTCRayHit ray = scene_->cast(direction, 0.0);
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      const Vector3d normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
      if (normal.dot(direction) > 0.0) return true;
    }
  return false;
}

}  // namespace penumbra::test
