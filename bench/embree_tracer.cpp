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

using Eigen::AlignedBox2d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int block = 4;  // pixels a side of a packet of 16 rays
constexpr int lanes = block * block;
constexpr int stream = 8;  // packets a call: 10 KiB, to stay in the first cache beside the tree

/// Columns of blocks in which a row of blocks holds something; first > last: nothing.
struct Columns {
  int first = std::numeric_limits<int>::max();
  int last = -1;
};

/// Points in the image whose convex hull holds what is to be traced.
using Outline = std::array<Vector2d, 8>;

Outline outline_of(const AlignedBox2d& box) {
  Outline points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = box.corner(static_cast<AlignedBox2d::CornerType>(i % 4));
  }
  return points;
}

/// From the least to the largest u that the convex hull has between two rows: the ends of the
/// segments between all pairs of its points, cut to the rows. Empty where none reaches them.
Eigen::AlignedBox1d extent(const Outline& points, double v0, double v1) {
  Eigen::AlignedBox1d columns;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const auto& [top, bottom] = points[i].y() < points[j].y() ? std::tie(points[i], points[j])
                                                                : std::tie(points[j], points[i]);
      if (bottom.y() < v0 || top.y() > v1) continue;
      const double height = std::max(bottom.y() - top.y(), 1e-9);
      for (const double v : {std::max(v0, top.y()), std::min(v1, bottom.y())}) {
        const double u = top.x() + (bottom.x() - top.x()) * (v - top.y()) / height;
        columns.extend(Eigen::Matrix<double, 1, 1>(u));
      }
    }
  }
  return columns;
}

}  // namespace

struct EmbreeTracer::State {
  struct Instance {
    std::size_t body;
    RTCGeometry geometry;
    std::array<Vector3d, 8> corners;  // of the body's bounding box
  };

  State(const Intrinsics& intrinsics, Region where) : k(intrinsics), region(where) {
    padded_width = (k.width() + block - 1) / block * block;
    const int padded_height = (k.height() + block - 1) / block * block;
    depth = Image<float>(padded_width, padded_height);
    for (int u = 0; u < padded_width; ++u) x.push_back(static_cast<float>(k.ray(u, 0).x()));
    for (int v = 0; v < padded_height; ++v) y.push_back(static_cast<float>(k.ray(0, v).y()));
    rows = padded_height / block;
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
  [[nodiscard]] Outline project(const Instance& instance, const Isometry3d& T_camera_body) const;
  void add_columns(const Outline& outline);
  void trace(int block_row, int first, int last);

  Intrinsics k;
  Region region;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  std::vector<Instance> instances;
  std::vector<float> x, y;  // rays' directions by column and row
  int padded_width = 0, rows = 0;
  Image<float> depth;
  std::array<RTCRayHit16, stream> packets{};
  std::vector<std::vector<Columns>> spans;   // per block row, per outline
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

Outline EmbreeTracer::State::project(const Instance& instance,
                                     const Isometry3d& T_camera_body) const {
  Outline points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d corner = T_camera_body * instance.corners[i];
    if (corner.z() < DepthRenderer::near_plane) {
      return outline_of({Vector2d::Zero(), Vector2d(k.width(), k.height())});
    }
    points[i] = k.project(corner);
  }
  return points;
}

/// Adds the blocks that the outline's convex hull meets, and a pixel around it.
void EmbreeTracer::State::add_columns(const Outline& outline) {
  const int blocks_per_row = padded_width / block;
  const double last_column = blocks_per_row - 1;
  for (int row = 0; row < rows; ++row) {
    const auto columns = extent(outline, row * block - 1.0, row * block + block);
    if (columns.isEmpty()) continue;
    const double low = columns.min().x();
    const double high = columns.max().x();
    if (high < -1.0 || low > k.width()) continue;
    spans[static_cast<std::size_t>(row)].push_back(
        {static_cast<int>(std::clamp((low - 1.0) / block, 0.0, last_column)),
         static_cast<int>(std::clamp((high + 1.0) / block, 0.0, last_column))});
  }
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

EmbreeTracer::EmbreeTracer(const Intrinsics& intrinsics, std::span<const Body> bodies,
                           Region region)
    : state_(std::make_unique<State>(intrinsics, region)) {
  for (std::size_t i = 0; i < bodies.size(); ++i) state_->add(bodies[i], i);
  state_->spans.resize(static_cast<std::size_t>(state_->rows));
  state_->traced.resize(static_cast<std::size_t>(state_->rows));
}

EmbreeTracer::~EmbreeTracer() = default;

ImageView<const float> EmbreeTracer::render(std::span<const Isometry3d> T_camera_body) {
  State& s = *state_;
  for (auto& row : s.spans) row.clear();
  AlignedBox2d rectangle;
  for (const State::Instance& instance : s.instances) {
    const Isometry3d& pose = T_camera_body[instance.body];
    const Eigen::Matrix<float, 3, 4> matrix = pose.matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(instance.geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(instance.geometry);
    const Outline outline = s.project(instance, pose);
    if (s.region == Region::hulls) s.add_columns(outline);
    for (const Vector2d& point : outline) rectangle.extend(point);
  }
  if (s.region == Region::rectangle && !rectangle.isEmpty()) s.add_columns(outline_of(rectangle));
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
