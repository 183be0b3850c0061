// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/workers.hpp>
#include <penumbra/cloud/cube_face-inl.hpp>
#include <penumbra/cloud/scan.hpp>
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

struct CloudLabeller::State {
  struct Measurement {
    Eigen::Vector3f ray;  // from the origin to the point
    std::uint32_t point;
  };
  using Measurements = std::vector<Measurement>;

  State(std::span<const Body> bodies, const CloudRule& cloud_rule, int threads);

  void begin(std::size_t points, std::span<const Eigen::Isometry3d> T_points_body,
             std::size_t parts);
  void place(std::size_t part);
  [[nodiscard]] std::optional<std::size_t> enclosing(const Eigen::Vector3d& point,
                                                     double margin = 0.0) const;
  void sort_points(const PointsView& points, const Eigen::Vector3f& origin,
                   std::span<const std::uint16_t> parts);
  void label_face(std::size_t part, std::size_t number, const Eigen::Vector3d& origin);
  [[nodiscard]] PointLabel look(const FacePoint& point) const;
  [[nodiscard]] PointLabel cast(const FacePoint& point) const;
  [[nodiscard]] std::uint16_t touching(const Eigen::Vector3d& point) const;
  void set(std::size_t point, const PointLabel& seen) {
    result.labels[point] = static_cast<std::uint8_t>(seen.label);
    result.links[point] = seen.link;
  }
  /// Calls `work(begin, end)` for parts of 0..count in all threads.
  template <typename F>
  void share(std::size_t count, const F& work);

  cloud::RangeRule rule;
  double tolerance;                               // at range 0
  std::vector<std::vector<TriangleTree>> bodies;  // a tree for each mesh
  std::unique_ptr<DepthRenderer> renderer;
  CubeFace face;
  std::vector<Eigen::Isometry3d> T_body_all;  // of each part
  std::span<const Eigen::Isometry3d> T_body_points;
  std::vector<Eigen::Isometry3d> T_face_body, T_body_face;
  std::vector<std::vector<Measurements>> sorted;  // of each thread: of each face of each part
  CloudLabels result;
  Workers workers;  // last: its threads use all of the above
};

CloudLabeller::State::State(std::span<const Body> given, const CloudRule& cloud_rule,
                            int thread_count)
    : rule((cloud_rule.check(), cloud_rule)),
      tolerance(cloud_rule.tolerance.a),
      renderer(make_depth_renderer(Backend::cpu, CubeFace::intrinsics(), given,
                                   {.threads = thread_count})),
      face(cloud_rule.beam),
      T_face_body(given.size()),
      T_body_face(given.size()),
      sorted(static_cast<std::size_t>(thread_count)),
      workers(thread_count) {
  for (const Body& body : given) bodies.emplace_back(body.meshes.begin(), body.meshes.end());
}

template <typename F>
void CloudLabeller::State::share(std::size_t count, const F& work) {
  struct Job {
    const F& work;
    std::size_t count;
    std::atomic<std::size_t> next{0};
  } job{work, count};
  workers.run(
      [](void* context, int) {
        Job& shared = *static_cast<Job*>(context);
        constexpr std::size_t block = 2048;
        for (std::size_t i; (i = shared.next.fetch_add(block)) < shared.count;)
          shared.work(i, std::min(i + block, shared.count));
      },
      &job);
}

void CloudLabeller::State::begin(std::size_t points,
                                 std::span<const Eigen::Isometry3d> T_points_body,
                                 std::size_t parts) {
  const auto fail = [](const std::string& fault) {
    throw std::invalid_argument("CloudLabeller::label(): " + fault);
  };
  if (T_points_body.size() != parts * bodies.size())
    fail(std::to_string(T_points_body.size()) + " poses for " + std::to_string(bodies.size()) +
         " bodies" + (parts == 1 ? "" : " in " + std::to_string(parts) + " parts"));
  for (const Eigen::Isometry3d& pose : T_points_body)
    if (!is_rigid(pose)) fail("a pose is not finite and rigid");
  if (points > std::numeric_limits<std::uint32_t>::max()) fail("too many points");
  result.labels.assign(points, static_cast<std::uint8_t>(Label::unknown));
  result.links.assign(points, 0);
  result.enclosing.reset();
  T_body_all.resize(T_points_body.size());
  for (std::size_t i = 0; i < T_body_all.size(); ++i) T_body_all[i] = T_points_body[i].inverse();
  place(0);
}

void CloudLabeller::State::place(std::size_t part) {
  T_body_points = std::span(T_body_all).subspan(part * bodies.size(), bodies.size());
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

/// Sorts the measurements by the part, and the face that shows them.
void CloudLabeller::State::sort_points(const PointsView& points, const Eigen::Vector3f& origin,
                                       std::span<const std::uint16_t> parts) {
  struct Job {
    State& self;
    const PointsView& points;
    const Eigen::Vector3f& origin;
    std::span<const std::uint16_t> parts;
  } job{*this, points, origin, parts};
  workers.run(
      [](void* context, int worker) {
        const Job& all = *static_cast<Job*>(context);
        const auto w = static_cast<std::size_t>(worker), n = all.self.sorted.size();
        auto& lists = all.self.sorted[w];
        for (std::size_t i = all.points.count * w / n; i < all.points.count * (w + 1) / n; ++i) {
          const Eigen::Vector3f ray = all.points[i] - all.origin;
          const float range = ray.norm();
          if (!(range >= static_cast<float>(least_range) && std::isfinite(range))) continue;
          const std::size_t part = all.parts.empty() ? 0 : all.parts[i];
          lists[part * CubeFace::count + CubeFace::of(ray)].push_back(
              {ray, static_cast<std::uint32_t>(i)});
        }
      },
      &job);
}

void CloudLabeller::State::label_face(std::size_t part, std::size_t number,
                                      const Eigen::Vector3d& origin) {
  const Eigen::Isometry3d T_face_points =
      Eigen::Isometry3d(CubeFace::frame(number)) * Eigen::Translation3d(-origin);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    T_body_face[i] = T_body_points[i] * T_face_points.inverse();
    T_face_body[i] = T_body_face[i].inverse();
  }
  const Eigen::Matrix3f R = T_face_points.linear().cast<float>();
  Eigen::AlignedBox2f where;
  for (const auto& lists : sorted)
    for (const Measurement& one : lists[part * CubeFace::count + number]) {
      const FacePoint point = CubeFace::place(R * one.ray);
      where.extend(Eigen::Vector2f(point.u, point.v));
    }
  face.show(renderer->render(T_face_body, face.window(where)));
  for (const auto& lists : sorted) {
    const Measurements& some = lists[part * CubeFace::count + number];
    share(some.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const FacePoint point = CubeFace::place(R * some[k].ray);
        set(some[k].point, face.holds_robot(point) ? look(point) : PointLabel{});
      }
    });
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

CloudLabeller::CloudLabeller(std::span<const Body> bodies, const CloudRule& rule, int threads)
    : state_(std::make_unique<State>(bodies, rule, threads)) {}
CloudLabeller::~CloudLabeller() = default;
CloudLabeller::CloudLabeller(CloudLabeller&&) noexcept = default;
CloudLabeller& CloudLabeller::operator=(CloudLabeller&&) noexcept = default;

void CloudLabeller::set_rule(const CloudRule& rule) {
  rule.check();
  state_->rule = cloud::RangeRule(rule);
  state_->tolerance = rule.tolerance.a;
  state_->face = CubeFace(rule.beam);
}

const CloudLabels& CloudLabeller::label(const PointsView& points, const Eigen::Vector3d& origin,
                                        std::span<const Eigen::Isometry3d> T_points_body,
                                        std::span<const std::uint16_t> parts) {
  State& s = *state_;
  if (!parts.empty() && parts.size() != points.count)
    throw std::invalid_argument("CloudLabeller::label(): " + std::to_string(parts.size()) +
                                " parts for " + std::to_string(points.count) + " points");
  const std::size_t count =
      parts.empty() ? 1 : std::size_t{*std::max_element(parts.begin(), parts.end())} + 1;
  s.begin(points.count, T_points_body, count);
  for (auto& lists : s.sorted) {
    if (lists.size() < count * CubeFace::count) lists.resize(count * CubeFace::count);
    for (auto& list : lists) list.clear();
  }
  s.sort_points(points, origin.cast<float>(), parts);
  for (std::size_t part = 0; part < count; ++part) {
    s.place(part);
    if (const auto body = s.enclosing(origin, least_range)) {
      s.result.enclosing = body;
      continue;
    }
    for (std::size_t i = 0; i < CubeFace::count; ++i)
      if (std::any_of(s.sorted.begin(), s.sorted.end(), [&](const auto& lists) {
            return !lists[part * CubeFace::count + i].empty();
          }))
        s.label_face(part, i, origin);
  }
  return s.result;
}

const CloudLabels& CloudLabeller::label(const PointsView& points,
                                        std::span<const Eigen::Isometry3d> T_points_body) {
  State& s = *state_;
  s.begin(points.count, T_points_body, 1);
  s.share(points.count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f point = points[i];
      if (!point.allFinite()) continue;
      const std::uint16_t link = s.touching(point.cast<double>());
      s.set(i, {link == 0 ? Label::clear : Label::occluded, link});
    }
  });
  return s.result;
}

}  // namespace penumbra
