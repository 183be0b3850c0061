// SPDX-License-Identifier: Apache-2.0
#include "embree_tracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <embree3/rtcore.h>

namespace penumbra::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int block = 4;  // pixels a side of a packet of 16 rays
constexpr int lanes = block * block;
constexpr int stream = 8;  // packets a call: 10 KiB, to stay in the first cache beside the tree

/// Blocks of pixels, the last ones included.
using Blocks = Eigen::AlignedBox2i;

}  // namespace

struct EmbreeTracer::State {
  struct Instance {
    std::size_t body;
    RTCGeometry geometry;
    std::array<Vector3d, 8> corners;  // of the body's bounding box
  };

  explicit State(const Intrinsics& intrinsics) : k(intrinsics) {
    padded_width = (k.width() + block - 1) / block * block;
    const int padded_height = (k.height() + block - 1) / block * block;
    depth = Image<float>(padded_width, padded_height);
    for (int u = 0; u < padded_width; ++u) x.push_back(static_cast<float>(k.ray(u, 0).x()));
    for (int v = 0; v < padded_height; ++v) y.push_back(static_cast<float>(k.ray(0, v).y()));
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    for (RTCRayHit16& packet : packets) {
      std::fill_n(packet.ray.dir_z, lanes, 1.0F);
      std::fill_n(packet.ray.tnear, lanes, static_cast<float>(DepthRenderer::near_plane));
      std::fill_n(packet.ray.mask, lanes, ~0U);
    }
  }
  ~State() {
    for (const Instance& instance : instances) rtcReleaseGeometry(instance.geometry);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void add(const Body& body, std::size_t index);
  [[nodiscard]] Blocks blocks_around(std::span<const Isometry3d> T_camera_body) const;
  void trace(int block_row, int first, int last);

  Intrinsics k;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  std::vector<Instance> instances;
  std::vector<float> x, y;  // rays' directions by column and row
  int padded_width = 0;
  Image<float> depth;
  std::array<RTCRayHit16, stream> packets{};
  Blocks traced;  // of the last frame
};

void EmbreeTracer::State::add(const Body& body, std::size_t index) {
  Eigen::AlignedBox3d bounds;
  RTCScene body_scene = rtcNewScene(device);
  rtcSetSceneFlags(body_scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(body_scene, RTC_BUILD_QUALITY_HIGH);
  for (const TriangleMesh& mesh : body.meshes) {
    if (mesh.triangles.empty()) continue;
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      Eigen::Map<Eigen::Vector3f>(vertices + 3 * i) = mesh.vertices[i];
      bounds.extend(mesh.vertices[i].cast<double>());
    }
    auto* const indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      std::copy_n(mesh.triangles[i].begin(), 3, indices + 3 * i);
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(body_scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  if (bounds.isEmpty()) {
    rtcReleaseScene(body_scene);
    return;
  }
  rtcCommitScene(body_scene);
  Instance& instance = instances.emplace_back();
  instance.body = index;
  instance.geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance.geometry, body_scene);
  rtcReleaseScene(body_scene);
  rtcAttachGeometry(scene, instance.geometry);
  for (int i = 0; i < 8; ++i) {
    instance.corners[static_cast<std::size_t>(i)] =
        bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  }
}

/// The blocks that the rectangle around all bodies' projected bounding boxes meets, and a pixel
/// around it; all where a corner is not before the near plane.
Blocks EmbreeTracer::State::blocks_around(std::span<const Isometry3d> T_camera_body) const {
  const Eigen::AlignedBox2d image(Vector2d::Zero(), Vector2d(k.width() - 1, k.height() - 1));
  Eigen::AlignedBox2d rectangle;
  for (const Instance& instance : instances)
    for (const Vector3d& in_body : instance.corners) {
      const Vector3d corner = T_camera_body[instance.body] * in_body;
      if (corner.z() < DepthRenderer::near_plane) {
        rectangle.extend(image);
      } else {
        const Vector2d pixel = k.project(corner);
        rectangle.extend(pixel - Vector2d::Ones()).extend(pixel + Vector2d::Ones());
      }
    }
  const Eigen::AlignedBox2d seen = rectangle.intersection(image);
  if (seen.isEmpty()) return {};
  return {(seen.min() / block).cast<int>(), (seen.max() / block).cast<int>()};
}

void EmbreeTracer::State::trace(int block_row, int first, int last) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (RTCRayHit16& packet : packets) {
    for (int i = 0; i < lanes; ++i) {
      const int v = block_row * block + i / block;
      packet.ray.dir_y[i] = y[static_cast<std::size_t>(v)];
    }
  }
  for (int column = first; column <= last; column += stream) {
    const int count = std::min(stream, last + 1 - column);
    for (int n = 0; n < count; ++n) {
      RTCRayHit16& packet = packets[static_cast<std::size_t>(n)];
      const int u = (column + n) * block;
      for (int line = 0; line < block; ++line) {
        std::copy_n(&x[static_cast<std::size_t>(u)], block, packet.ray.dir_x + line * block);
      }
      std::fill_n(packet.ray.tfar, lanes, std::numeric_limits<float>::infinity());
      std::fill_n(packet.hit.geomID, lanes, RTC_INVALID_GEOMETRY_ID);
    }
    rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets.data()), lanes,
                   static_cast<unsigned>(count), sizeof(RTCRayHit16));
    for (int n = 0; n < count; ++n) {
      const RTCRayHit16& packet = packets[static_cast<std::size_t>(n)];
      for (int i = 0; i < lanes; ++i) {
        const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        depth((column + n) * block + i % block, block_row * block + i / block) =
            hit ? packet.ray.tfar[i] : 0.0F;
      }
    }
  }
}

EmbreeTracer::EmbreeTracer(const Intrinsics& intrinsics, std::span<const Body> bodies)
    : state_(std::make_unique<State>(intrinsics)) {
  for (std::size_t i = 0; i < bodies.size(); ++i) state_->add(bodies[i], i);
}

EmbreeTracer::~EmbreeTracer() = default;

ImageView<const float> EmbreeTracer::render(std::span<const Isometry3d> T_camera_body) {
  State& s = *state_;
  for (const State::Instance& instance : s.instances) {
    const Eigen::Matrix<float, 3, 4> matrix =
        T_camera_body[instance.body].matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(instance.geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(instance.geometry);
  }
  rtcCommitScene(s.scene);
  if (!s.traced.isEmpty())
    for (int v = s.traced.min().y() * block; v < (s.traced.max().y() + 1) * block; ++v)
      std::fill(&s.depth(s.traced.min().x() * block, v),
                &s.depth(s.traced.max().x() * block, v) + block, 0.0F);
  s.traced = s.blocks_around(T_camera_body);
  for (int row = s.traced.min().y(); row <= s.traced.max().y(); ++row)
    s.trace(row, s.traced.min().x(), s.traced.max().x());
  return {s.depth.data(), s.k.width(), s.k.height(), s.padded_width};
}

}  // namespace penumbra::bench
