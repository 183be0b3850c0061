// SPDX-License-Identifier: Apache-2.0
#include "shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace example {
namespace {

constexpr std::size_t run_length = 24;  // triangles; measured to be about the fastest

/// Appends rings of vertices that are joined to skins, and closes both ends with a fan.
Mesh skin(const std::vector<std::vector<Vector3d>>& rings, const Vector3d& bottom,
          const Vector3d& top) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(rings.front().size());
  mesh.vertices.push_back(bottom);
  for (const auto& ring : rings)
    mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  mesh.vertices.push_back(top);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  const auto start = [n](std::size_t ring) { return 1 + static_cast<std::uint32_t>(ring) * n; };

  for (std::uint32_t i = 0; i < n; ++i)
    mesh.triangles.push_back({0, start(0) + (i + 1) % n, start(0) + i});
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = start(r) + i, b = start(r) + (i + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i)
    mesh.triangles.push_back(
        {last, start(rings.size() - 1) + i, start(rings.size() - 1) + (i + 1) % n});
  return mesh;
}

double signed_power(double x, double exponent) {
  return std::copysign(std::pow(std::abs(x), exponent), x);
}

std::optional<Hit> hit_sphere(const Vector3d& centre, double radius, const Ray& ray) {
  const Vector3d o = ray.origin - centre;
  const double a = ray.direction.squaredNorm();
  const double half_b = o.dot(ray.direction);
  const double root = half_b * half_b - a * (o.squaredNorm() - radius * radius);
  if (root < 0.0) return {};
  double t = (-half_b - std::sqrt(root)) / a;
  if (t <= 0.0) t = (-half_b + std::sqrt(root)) / a;
  if (t <= 0.0) return {};
  return Hit{t, o + t * ray.direction};
}

void keep_nearest(std::optional<Hit>& best, const std::optional<Hit>& hit) {
  if (hit && (!best || hit->t < best->t)) best = hit;
}

/// The side of a cylinder about z between -half and half; both crossings are tried.
std::optional<Hit> hit_side(double radius, double half, const Ray& ray) {
  const auto o = ray.origin.head<2>();
  const auto d = ray.direction.head<2>();
  const double a = d.squaredNorm();
  const double half_b = o.dot(d);
  const double root = half_b * half_b - a * (o.squaredNorm() - radius * radius);
  if (a == 0.0 || root < 0.0) return {};
  for (const double t : {(-half_b - std::sqrt(root)) / a, (-half_b + std::sqrt(root)) / a}) {
    const Vector3d p = ray.origin + t * ray.direction;
    if (t > 0.0 && std::abs(p.z()) <= half) return Hit{t, {p.x(), p.y(), 0.0}};
  }
  return {};
}

std::optional<Hit> hit(const Sphere& s, const Ray& ray) {
  return hit_sphere(Vector3d::Zero(), s.radius, ray);
}

std::optional<Hit> hit(const Cylinder& c, const Ray& ray) {
  const double half = c.length / 2.0;
  std::optional<Hit> best = hit_side(c.radius, half, ray);
  for (const double z : {-half, half}) {
    const double t = (z - ray.origin.z()) / ray.direction.z();
    const Vector3d p = ray.origin + t * ray.direction;
    if (t > 0.0 && p.head<2>().squaredNorm() <= c.radius * c.radius)
      keep_nearest(best, Hit{t, {0.0, 0.0, z}});
  }
  return best;
}

std::optional<Hit> hit(const Capsule& c, const Ray& ray) {
  const double half = c.length / 2.0;
  std::optional<Hit> best = hit_side(c.radius, half, ray);
  for (const double z : {-half, half}) keep_nearest(best, hit_sphere({0, 0, z}, c.radius, ray));
  return best;
}

/// Where the ray's line is inside the box: t from first to last, if it is at all.
std::optional<std::array<double, 2>> span_in(const Eigen::AlignedBox3d& box, const Ray& ray) {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (ray.direction[i] == 0.0) {
      if (ray.origin[i] < box.min()[i] || ray.origin[i] > box.max()[i]) return {};
      continue;
    }
    const double a = (box.min()[i] - ray.origin[i]) / ray.direction[i];
    const double b = (box.max()[i] - ray.origin[i]) / ray.direction[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return {};
  return {{first, last}};
}

std::optional<Hit> hit(const Box& b, const Ray& ray) {
  const auto span = span_in({-b.size / 2.0, b.size / 2.0}, ray);
  if (!span || (*span)[1] <= 0.0) return {};
  const double t = (*span)[0] > 0.0 ? (*span)[0] : (*span)[1];
  const Vector3d p = (ray.origin + t * ray.direction).cwiseQuotient(b.size);
  int axis = 0;
  p.cwiseAbs().maxCoeff(&axis);
  Vector3d normal = Vector3d::Zero();
  normal[axis] = p[axis];
  return Hit{t, normal};
}

/// Möller and Trumbore 1997, both sides.
std::optional<Hit> hit_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                const Ray& ray) {
  const Vector3d ab = b - a, ac = c - a;
  const Vector3d p = ray.direction.cross(ac);
  const double det = ab.dot(p);
  if (det == 0.0) return {};
  const Vector3d o = ray.origin - a;
  const double u = o.dot(p) / det;
  if (u < 0.0 || u > 1.0) return {};
  const Vector3d q = o.cross(ab);
  const double v = ray.direction.dot(q) / det;
  if (v < 0.0 || u + v > 1.0) return {};
  const double t = ac.dot(q) / det;
  if (t <= 0.0) return {};
  return Hit{t, ab.cross(ac)};
}

std::optional<Hit> hit(const std::shared_ptr<const TracedMesh>& traced, const Ray& ray) {
  const Mesh& mesh = traced->mesh();
  std::optional<Hit> best;
  for (const auto& run : traced->runs()) {
    if (!span_in(run.bounds, ray)) continue;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      keep_nearest(best, hit_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], ray));
    }
  }
  return best;
}

Eigen::AlignedBox3d symmetric(const Vector3d& half) { return {-half, half}; }

Eigen::AlignedBox3d bounds_of(const Sphere& s) { return symmetric(Vector3d::Constant(s.radius)); }
Eigen::AlignedBox3d bounds_of(const Cylinder& c) {
  return symmetric({c.radius, c.radius, c.length / 2.0});
}
Eigen::AlignedBox3d bounds_of(const Capsule& c) {
  return symmetric({c.radius, c.radius, c.length / 2.0 + c.radius});
}
Eigen::AlignedBox3d bounds_of(const Box& b) { return symmetric(b.size / 2.0); }
Eigen::AlignedBox3d bounds_of(const std::shared_ptr<const TracedMesh>& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh->mesh().vertices) box.extend(v);
  return box;
}

}  // namespace

TracedMesh::TracedMesh(Mesh mesh) : mesh_(std::move(mesh)) {
  for (std::size_t begin = 0; begin < mesh_.triangles.size(); begin += run_length) {
    Run run{begin, std::min(begin + run_length, mesh_.triangles.size()), {}};
    for (std::size_t i = run.begin; i < run.end; ++i)
      for (const auto v : mesh_.triangles[i]) run.bounds.extend(mesh_.vertices[v]);
    runs_.push_back(run);
  }
}

std::optional<Hit> intersect(const Shape& shape, const Ray& ray) {
  return std::visit([&](const auto& s) { return hit(s, ray); }, shape);
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return bounds_of(s); }, shape);
}

bool meets(const Eigen::AlignedBox3d& box, const Ray& ray) { return span_in(box, ray).has_value(); }

Mesh turned(const std::vector<Vector2d>& profile, int segments) {
  std::vector<Section> sections;
  for (const auto& p : profile)
    if (p.x() > 0.0) sections.push_back({p.y(), p.x(), p.x()});
  return lofted(sections, 2.0, segments);
}

Mesh lofted(const std::vector<Section>& sections, double exponent, int segments) {
  std::vector<std::vector<Vector3d>> rings;
  for (const auto& s : sections) {
    auto& ring = rings.emplace_back();
    for (int i = 0; i < segments; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / segments;
      ring.emplace_back(s.x + s.half_x * signed_power(std::cos(angle), 2.0 / exponent),
                        s.y + s.half_y * signed_power(std::sin(angle), 2.0 / exponent), s.z);
    }
  }
  const auto& low = sections.front();
  const auto& high = sections.back();
  return skin(rings, {low.x, low.y, low.z}, {high.x, high.y, high.z});
}

Mesh moved(const Mesh& mesh, const Isometry3d& T) {
  Mesh result = mesh;
  for (auto& v : result.vertices) v = T * v;
  return result;
}

}  // namespace example
