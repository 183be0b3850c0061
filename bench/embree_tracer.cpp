// SPDX-License-Identifier: Apache-2.0
#include "embree_tracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <embree3/rtcore.h>

namespace penumbra::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int block = 4;  // pixels a side of a packet of 16 rays
constexpr int lanes = block * block;

/// Columns of blocks in which a row of blocks holds something; first > last: nothing.
struct Columns {
  int first = std::numeric_limits<int>::max();
  int last = -1;
};

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
    rows = padded_height / block;
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  }
  ~State() {
    for (const Instance& instance : instances) rtcReleaseGeometry(instance.geometry);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void add(const Body& body, std::size_t index);
  void add_columns(const Instance& instance, const Isometry3d& T_camera_body,
                   std::vector<std::vector<Columns>>& spans) const;
  void trace(int block_row, int first, int last);

  Intrinsics k;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  std::vector<Instance> instances;
  std::vector<float> x, y;  // rays' directions by column and row
  int padded_width = 0, rows = 0;
  Image<float> depth;
  std::vector<std::vector<Columns>> spans;   // per block row, per instance
  std::vector<std::vector<Columns>> traced;  // joined, of the last frame
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

/// Which blocks the convex hull of the projected box meets: in every row of blocks, from the least
/// to the largest u of the segments between all pairs of corners, cut to the row.
void EmbreeTracer::State::add_columns(const Instance& instance, const Isometry3d& T_camera_body,
                                      std::vector<std::vector<Columns>>& out) const {
  std::array<Vector2d, 8> p;
  bool near = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector3d corner = T_camera_body * instance.corners[i];
    near = near || corner.z() < DepthRenderer::near_plane;
    p[i] = k.project(corner);
  }
  const int last_column = padded_width / block - 1;
  for (int row = 0; row < rows; ++row) {
    const double v0 = row * block - 1.0;
    const double v1 = row * block + block;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; !near && i < p.size(); ++i) {
      for (std::size_t j = i + 1; j < p.size(); ++j) {
        const auto& [top, bottom] =
            p[i].y() < p[j].y() ? std::tie(p[i], p[j]) : std::tie(p[j], p[i]);
        if (bottom.y() < v0 || top.y() > v1) continue;
        const double height = std::max(bottom.y() - top.y(), 1e-9);
        for (const double v : {std::max(v0, top.y()), std::min(v1, bottom.y())}) {
          const double u = top.x() + (bottom.x() - top.x()) * (v - top.y()) / height;
          low = std::min(low, u);
          high = std::max(high, u);
        }
      }
    }
    if (near) {
      low = 0.0;
      high = k.width();
    }
    if (!(low <= high) || high < -1.0 || low > k.width()) continue;
    out[static_cast<std::size_t>(row)].push_back(
        {static_cast<int>(std::clamp((low - 1.0) / block, 0.0, static_cast<double>(last_column))),
         static_cast<int>(
             std::clamp((high + 1.0) / block, 0.0, static_cast<double>(last_column)))});
  }
}

void EmbreeTracer::State::trace(int block_row, int first, int last) {
  alignas(64) static constexpr std::array<int, lanes> valid = [] {
    std::array<int, lanes> all{};
    all.fill(-1);
    return all;
  }();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) RTCRayHit16 packet{};
  for (int column = first; column <= last; ++column) {
    for (int i = 0; i < lanes; ++i) {
      packet.ray.dir_x[i] = x[static_cast<std::size_t>(column * block + i % block)];
      packet.ray.dir_y[i] = y[static_cast<std::size_t>(block_row * block + i / block)];
      packet.ray.dir_z[i] = 1.0F;
      packet.ray.tnear[i] = static_cast<float>(DepthRenderer::near_plane);
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.ray.mask[i] = ~0U;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid.data(), scene, &context, &packet);
    for (int i = 0; i < lanes; ++i) {
      const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      depth(column * block + i % block, block_row * block + i / block) =
          hit ? packet.ray.tfar[i] : 0.0F;
    }
  }
}

EmbreeTracer::EmbreeTracer(const Intrinsics& intrinsics, std::span<const Body> bodies)
    : state_(std::make_unique<State>(intrinsics)) {
  for (std::size_t i = 0; i < bodies.size(); ++i) state_->add(bodies[i], i);
  state_->spans.resize(static_cast<std::size_t>(state_->rows));
  state_->traced.resize(static_cast<std::size_t>(state_->rows));
}

EmbreeTracer::~EmbreeTracer() = default;

ImageView<const float> EmbreeTracer::render(std::span<const Isometry3d> T_camera_body) {
  State& s = *state_;
  for (auto& row : s.spans) row.clear();
  for (const State::Instance& instance : s.instances) {
    const Isometry3d& pose = T_camera_body[instance.body];
    const Eigen::Matrix<float, 3, 4> matrix = pose.matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(instance.geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(instance.geometry);
    s.add_columns(instance, pose, s.spans);
  }
  rtcCommitScene(s.scene);
  for (int row = 0; row < s.rows; ++row) {
    auto& spans = s.spans[static_cast<std::size_t>(row)];
    auto& traced = s.traced[static_cast<std::size_t>(row)];
    for (const Columns& old : traced) {
      for (int v = row * block; v < (row + 1) * block; ++v) {
        std::fill(&s.depth(old.first * block, v),
                  &s.depth(old.first * block, v) + (old.last + 1 - old.first) * block, 0.0F);
      }
    }
    traced.clear();
    std::sort(spans.begin(), spans.end(),
              [](const Columns& a, const Columns& b) { return a.first < b.first; });
    for (const Columns& span : spans) {
      if (!traced.empty() && span.first <= traced.back().last + 1) {
        traced.back().last = std::max(traced.back().last, span.last);
      } else {
        traced.push_back(span);
      }
    }
    for (const Columns& span : traced) s.trace(row, span.first, span.last);
  }
  return {s.depth.data(), s.k.width(), s.k.height(), s.padded_width};
}

}  // namespace penumbra::bench
