// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/cloud/cloud_labels.hpp>
#include <penumbra/cloud/cube_face-inl.hpp>
#include <penumbra/mesh/triangle_tree.hpp>

namespace penumbra {

using cloud::CubeFace;
using cloud::FacePoint;
using cloud::PointLabel;

Eigen::Vector3f PointsView::operator[](std::size_t i) const {
  Eigen::Vector3f point;
  std::memcpy(point.data(), data + static_cast<std::ptrdiff_t>(i) * stride, 3 * sizeof(float));
  return point;
}

void CloudRule::check() const {
  check_settings(*this);
  if (!tolerance.is_valid())
    throw InputError("tolerance " + std::to_string(tolerance.a) + "," +
                     std::to_string(tolerance.b) + "," + std::to_string(tolerance.c) +
                     ": a + b s + c s^2 must be finite and not negative at any range");
}

struct CloudLabeller::State {
  struct Measurement {
    Eigen::Vector3f ray;  // from the origin to the point
    std::uint32_t point;
  };

  State(std::span<const Body> bodies, const CloudRule& cloud_rule);

  void begin(std::size_t points, std::span<const Eigen::Isometry3d> T_points_body);
  [[nodiscard]] std::optional<std::size_t> enclosing(const Eigen::Vector3d& point,
                                                     double margin = 0.0) const;
  void sort_points(const PointsView& points, const Eigen::Vector3f& origin);
  void label_face(std::size_t number, const Eigen::Vector3d& origin);
  [[nodiscard]] PointLabel look(const FacePoint& point) const;
  [[nodiscard]] PointLabel cast(const FacePoint& point) const;
  [[nodiscard]] std::uint16_t touching(const Eigen::Vector3d& point) const;
  void set(std::size_t point, const PointLabel& seen) {
    result.labels[point] = static_cast<std::uint8_t>(seen.label);
    result.links[point] = seen.link;
  }

  cloud::RangeRule rule;
  double tolerance;                               // at range 0
  std::vector<std::vector<TriangleTree>> bodies;  // a tree for each mesh
  std::unique_ptr<DepthRenderer> renderer;
  CubeFace face;
  std::array<std::vector<Measurement>, CubeFace::count> of_face;
  std::vector<Eigen::Isometry3d> T_body_points, T_face_body, T_body_face;
  CloudLabels result;
};

CloudLabeller::State::State(std::span<const Body> given, const CloudRule& cloud_rule)
    : rule((cloud_rule.check(), cloud_rule)),
      tolerance(cloud_rule.tolerance.a),
      renderer(make_depth_renderer(Backend::cpu, CubeFace::intrinsics(), given)),
      face(cloud_rule.beam),
      T_body_points(given.size()),
      T_face_body(given.size()),
      T_body_face(given.size()) {
  for (const Body& body : given) bodies.emplace_back(body.meshes.begin(), body.meshes.end());
}

void CloudLabeller::State::begin(std::size_t points,
                                 std::span<const Eigen::Isometry3d> T_points_body) {
  const auto fail = [](const std::string& fault) {
    throw std::invalid_argument("CloudLabeller::label(): " + fault);
  };
  if (T_points_body.size() != bodies.size())
    fail(std::to_string(T_points_body.size()) + " poses for " + std::to_string(bodies.size()) +
         " bodies");
  for (const Eigen::Isometry3d& pose : T_points_body)
    if (!is_rigid(pose)) fail("a pose is not finite and rigid");
  if (points > std::numeric_limits<std::uint32_t>::max()) fail("too many points");
  result.labels.assign(points, static_cast<std::uint8_t>(Label::unknown));
  result.links.assign(points, 0);
  result.enclosing.reset();
  for (std::size_t i = 0; i < bodies.size(); ++i) T_body_points[i] = T_points_body[i].inverse();
}

std::optional<std::size_t> CloudLabeller::State::enclosing(const Eigen::Vector3d& point,
                                                           double margin) const {
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const TriangleTree& mesh : bodies[i])
      if (mesh.encloses(T_body_points[i] * point) ||
          mesh.distance(T_body_points[i] * point, margin) < margin)
        return i;
  return std::nullopt;
}

/// Sorts the measurements by the faces that show them.
void CloudLabeller::State::sort_points(const PointsView& points, const Eigen::Vector3f& origin) {
  for (auto& some : of_face) some.clear();
  for (std::size_t i = 0; i < points.count; ++i) {
    const Eigen::Vector3f ray = points[i] - origin;
    const float range = ray.norm();
    if (!(range >= static_cast<float>(least_range) && std::isfinite(range))) continue;
    of_face[CubeFace::of(ray)].push_back({ray, static_cast<std::uint32_t>(i)});
  }
}

void CloudLabeller::State::label_face(std::size_t number, const Eigen::Vector3d& origin) {
  const Eigen::Isometry3d T_face_points =
      Eigen::Isometry3d(CubeFace::frame(number)) * Eigen::Translation3d(-origin);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    T_body_face[i] = T_body_points[i] * T_face_points.inverse();
    T_face_body[i] = T_body_face[i].inverse();
  }
  face.show(renderer->render(T_face_body));
  const Eigen::Matrix3f R = T_face_points.linear().cast<float>();
  for (const auto& [ray, i] : of_face[number]) {
    const FacePoint point = CubeFace::place(R * ray);
    set(i, face.holds_robot(point) ? look(point) : PointLabel{});
  }
}

PointLabel CloudLabeller::State::look(const FacePoint& point) const {
  const auto agreed = face.label(point, rule);
  const PointLabel seen = agreed ? *agreed : cast(point);
  if (!is_trusted(seen.label)) return seen;
  const std::uint16_t mixed = face.mixed_link(point, rule);
  return mixed == 0 ? seen : PointLabel{Label::fringe, mixed};
}

/// Casts the point's ray.
PointLabel CloudLabeller::State::cast(const FacePoint& point) const {
  const Eigen::Vector3d direction = point.ray.cast<double>().normalized();
  double nearest = TriangleTree::nowhere;
  std::size_t body = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Eigen::Vector3d along = T_body_face[i].linear() * direction;
    for (const TriangleTree& mesh : bodies[i]) {
      const double s = mesh.first_hit(T_body_face[i].translation(), along, nearest);
      if (s < nearest) {
        nearest = s;
        body = i;
      }
    }
  }
  if (nearest == TriangleTree::nowhere) return {};
  return {rule.on_robot(point.range, static_cast<float>(nearest)),
          static_cast<std::uint16_t>(body + 1)};
}

/// Returns the body, + 1, on or in which a point lies; 0: none.
std::uint16_t CloudLabeller::State::touching(const Eigen::Vector3d& point) const {
  double nearest = std::nextafter(tolerance, TriangleTree::nowhere);
  std::uint16_t link = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const TriangleTree& mesh : bodies[i]) {
      const double distance = mesh.distance(T_body_points[i] * point, nearest);
      if (distance >= nearest) continue;
      nearest = distance;
      link = static_cast<std::uint16_t>(i + 1);
    }
  if (link != 0) return link;
  const auto around = enclosing(point);
  return around ? static_cast<std::uint16_t>(*around + 1) : std::uint16_t{0};
}

CloudLabeller::CloudLabeller(std::span<const Body> bodies, const CloudRule& rule)
    : state_(std::make_unique<State>(bodies, rule)) {}
CloudLabeller::~CloudLabeller() = default;
CloudLabeller::CloudLabeller(CloudLabeller&&) noexcept = default;
CloudLabeller& CloudLabeller::operator=(CloudLabeller&&) noexcept = default;

const CloudLabels& CloudLabeller::label(const PointsView& points, const Eigen::Vector3d& origin,
                                        std::span<const Eigen::Isometry3d> T_points_body) {
  State& s = *state_;
  s.begin(points.count, T_points_body);
  s.result.enclosing = s.enclosing(origin, least_range);
  if (s.result.enclosing) return s.result;
  s.sort_points(points, origin.cast<float>());
  for (std::size_t i = 0; i < CubeFace::count; ++i)
    if (!s.of_face[i].empty()) s.label_face(i, origin);
  return s.result;
}

const CloudLabels& CloudLabeller::label(const PointsView& points,
                                        std::span<const Eigen::Isometry3d> T_points_body) {
  State& s = *state_;
  s.begin(points.count, T_points_body);
  for (std::size_t i = 0; i < points.count; ++i) {
    const Eigen::Vector3f point = points[i];
    if (!point.allFinite()) continue;
    const std::uint16_t link = s.touching(point.cast<double>());
    s.set(i, {link == 0 ? Label::clear : Label::occluded, link});
  }
  return s.result;
}

}  // namespace penumbra
