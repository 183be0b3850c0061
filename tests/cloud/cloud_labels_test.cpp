// SPDX-License-Identifier: Apache-2.0
// Labels of points against Embree's rays and closed forms.
#include "../support/test.hpp"
#include "embree_oracle.hpp"
#include "scene.hpp"
#include "shapes.hpp"

#include <penumbra/cloud/scan.hpp>
#include <penumbra/mesh/triangle_tree.hpp>

namespace penumbra::test {
namespace {

constexpr double tolerance = 0.02;  // metres

/// Distances and directions within which Embree and the code may round to different sides: those of
/// float32 at some metres.
constexpr double rounding = 5e-6;

/// Where a ray from the origin meets the bodies first.
struct Surface {
  double range;
  std::size_t body;
};

/// Embree looks forwards only: one scene for each direction of the axes.
class AllAround {
 public:
  AllAround(std::span<const Body> bodies, std::span<const Isometry3d> poses) {
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3d axis = (i < 3 ? 1.0 : -1.0) * Vector3d::Unit(int(i % 3));
      turns_.emplace_back(turn(axis, Vector3d::UnitZ()));
      std::vector<Isometry3d> turned;
      for (const Isometry3d& pose : poses) turned.push_back(turns_.back() * pose);
      oracles_.emplace_back(bodies, turned);
    }
  }

  [[nodiscard]] std::optional<Surface> first(const Vector3d& direction) const {
    Eigen::Index axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    const auto i = std::size_t(axis + (direction[axis] > 0 ? 0 : 3));
    const Vector3d turned = turns_[i] * direction;
    const auto hit = oracles_[i].first_hit(turned / turned.z(), 0.0);
    if (!hit) return std::nullopt;
    return Surface{hit->z * (turned / turned.z()).norm(), hit->body};
  }

 private:
  std::vector<Eigen::Quaterniond> turns_;
  std::vector<EmbreeOracle> oracles_;
};

/// A cloud with an intensity after each point.
class Points {
 public:
  void add(const Vector3d& point) {
    for (int i = 0; i < 3; ++i) values_.push_back(float(point[i]));
    values_.push_back(1.0F);
  }
  [[nodiscard]] Vector3d operator[](std::size_t i) const { return view()[i].cast<double>(); }
  [[nodiscard]] std::size_t size() const { return values_.size() / 4; }
  [[nodiscard]] PointsView view() const {
    return {reinterpret_cast<const std::byte*>(values_.data()), size(), 4 * sizeof(float)};
  }

 private:
  std::vector<float> values_;
};

/// Bodies of many kinds around the origin, none around it.
Scene random_scene(std::mt19937_64& random) {
  Scene scene;
  std::uniform_real_distribution<float> size(0.05F, 0.4F);
  std::uniform_real_distribution<double> distance(0.8, 3.0);
  const auto place = [&](const TriangleMesh& mesh) {
    Isometry3d pose = random_pose(random, Vector3d::Zero(), Vector3d::Zero());
    pose.translation() = distance(random) * random_direction(random);
    scene.add(mesh, pose);
  };
  for (int i = 0; i < 4; ++i) {
    place(box({size(random), size(random), size(random)}));
    place(sphere(size(random), 12));
    place(torus(12, 24, 0.3, 0.08));
    place(revolved({{0.0F, -0.3F}, {0.2F, -0.3F}, {0.0F, 0.3F}}, 16));  // a cone
  }
  return scene;
}

/// Directions, half of them at corners of the bodies, where outlines are.
std::vector<Vector3d> random_directions(std::mt19937_64& random, const Scene& scene, int count) {
  constexpr double nearby = 2e-3;  // radians
  std::vector<Vector3d> corners;
  const std::vector<Body> bodies = scene.bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const PreparedMesh& mesh : bodies[i].meshes)
      for (const Vector3f& vertex : mesh.vertices)
        corners.push_back((scene.poses[i] * vertex.cast<double>()).normalized());
  std::uniform_int_distribution<std::size_t> any(0, corners.size() - 1);
  std::vector<Vector3d> directions;
  directions.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i)
    directions.push_back(
        i % 2 == 0 ? random_direction(random)
                   : (corners[any(random)] + nearby * random_direction(random)).normalized());
  return directions;
}

/// Ranges before, on and behind the robot.
double random_range(std::mt19937_64& random, const std::optional<Surface>& surface) {
  std::uniform_real_distribution<double> far(0.3, 6.0), near(-5 * tolerance, 5 * tolerance);
  if (!surface || random() % 2 == 0) return far(random);
  return surface->range + near(random);
}

CloudRule rule_of(double beam) {
  return {.tolerance = {tolerance, 0, 0}, .beyond_factor = 2, .beam = beam, .mixing = 0.5};
}

/// Whether a point may have a label: where it lies by rounding on a limit, one of several.
bool fits(Label label, std::uint16_t link, double range, const std::optional<Surface>& surface) {
  if (!surface) return label == Label::clear && link == 0;
  const auto label_at = [&](double r) {
    return r < surface->range - tolerance       ? Label::front
           : r > surface->range + 2 * tolerance ? Label::beyond
                                                : Label::occluded;
  };
  return link == surface->body + 1 &&
         (label == label_at(range - rounding) || label == label_at(range + rounding));
}

TEST(CloudLabels, AreThoseOfEmbreesRays) {
  std::mt19937_64 random = seeded_random(42);
  std::array<int, label_count> counts{};
  for (int round = 0; round < 10; ++round) {
    const Scene scene = random_scene(random);
    const AllAround oracle(scene.bodies(), scene.poses);
    CloudLabeller labeller(scene.bodies(), rule_of(0.0));
    // The sensor stands elsewhere in the points' frame; all at the same places seen from it.
    const Vector3d origin(0.5 * round, -0.25 * round, 0.125 * round);
    std::vector<Isometry3d> poses;
    for (const Isometry3d& pose : scene.poses) poses.push_back(Translation3d(origin) * pose);
    Points points, moved;
    for (const Vector3d& direction : random_directions(random, scene, 20'000)) {
      points.add(random_range(random, oracle.first(direction)) * direction);
      moved.add(origin + points[points.size() - 1]);
    }
    const CloudLabels& found = labeller.label(moved.view(), origin, poses);
    ASSERT_FALSE(found.enclosing);
    ASSERT_EQ(found.labels.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto label = static_cast<Label>(found.labels[i]);
      const Vector3d point = moved[i] - origin;
      const double range = point.norm();
      ++counts[found.labels[i]];
      bool fits_one = fits(label, found.links[i], range, oracle.first(point));
      for (int nearby = 0; nearby < 20 && !fits_one; ++nearby)  // rays through an edge
        fits_one = fits(label, found.links[i], range,
                        oracle.first(point + rounding * random_direction(random)));
      ASSERT_TRUE(fits_one) << "round " << round << ", point " << points[i].transpose()
                            << ", label " << int(label) << ", link " << found.links[i];
    }
  }
  for (const Label label : {Label::clear, Label::front, Label::occluded, Label::beyond})
    EXPECT_GT(counts[std::size_t(label)], 5'000);
}

TEST(CloudLabels, FringeIsWhatABeamMixesWithTheRobot) {
  constexpr double beam = 0.004;
  constexpr double grid = 0.0025;       // radians: rays are tested about 0.1 degrees apart
  constexpr double most_missed = 0.02;  // tips between these rays
  std::mt19937_64 random = seeded_random(43);
  int fringe = 0, clear = 0, missed = 0;
  for (int round = 0; round < 5; ++round) {
    const Scene scene = random_scene(random);
    const AllAround oracle(scene.bodies(), scene.poses);
    CloudLabeller labeller(scene.bodies(), rule_of(beam));
    Points points;
    for (const Vector3d& direction : random_directions(random, scene, 4'000))
      points.add(random_range(random, oracle.first(direction)) * direction);
    const CloudLabels& found = labeller.label(points.view(), Vector3d::Zero(), scene.poses);
    ASSERT_FALSE(found.enclosing);
    // Whether a ray at most `within` from a point's meets robot that the point may be mixed of.
    const auto may_be_mixed = [&](const Vector3d& point, double within) {
      const double range = point.norm();
      for (int ring = 0; ring <= 8; ++ring)
        for (int k = 0; k < 24; ++k) {
          const Vector3d across = point.unitOrthogonal();
          const Vector3d nearby = AngleAxisd(k * std::numbers::pi / 12, point / range) * across;
          const auto surface = oracle.first(point / range + within * ring / 8 * nearby);
          if (surface && surface->range - tolerance <= range && range <= surface->range + 0.5)
            return true;
        }
      return false;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto label = static_cast<Label>(found.labels[i]);
      if (label == Label::fringe) {
        ++fringe;
        ASSERT_TRUE(may_be_mixed(points[i], beam + grid)) << points[i].transpose();
      } else if (is_trusted(label)) {
        clear += label == Label::clear ? 1 : 0;
        missed += may_be_mixed(points[i], beam) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(fringe, 300);
  EXPECT_LT(missed, most_missed * fringe) << "of " << fringe;
  EXPECT_GT(clear, 3'000);
}

TEST(CloudLabels, WithoutRaysAreByDistance) {
  std::mt19937_64 random = seeded_random(44);
  Scene scene;
  const Isometry3d pose = random_pose(random, {1, 1, 1}, {2, 2, 2});
  scene.add(box({0.3F, 0.2F, 0.5F}), pose);
  CloudLabeller labeller(scene.bodies(), rule_of(0.0));
  Points points;
  for (int i = 0; i < 20'000; ++i) points.add(pose * (Vector3d::Random() * 0.7));
  const CloudLabels& found = labeller.label(points.view(), scene.poses);
  int on = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3d q =
        (pose.inverse() * points[i]).array().abs() - Eigen::Array3d(0.3, 0.2, 0.5);
    const double distance = q.max(0.0).matrix().norm() - tolerance;
    if (std::abs(distance) < rounding) continue;
    on += distance < 0 ? 1 : 0;
    ASSERT_EQ(found.labels[i], std::uint8_t(distance < 0 ? Label::occluded : Label::clear));
    ASSERT_EQ(found.links[i], distance < 0 ? 1 : 0);
  }
  EXPECT_GT(on, 1'000);
}

TEST(CloudLabels, PointsWithoutMeasurementAreUnknown) {
  Scene scene;
  scene.add(box({0.1F, 0.1F, 0.1F}), at(0, 0, 1));
  CloudLabeller labeller(scene.bodies());
  Points points;
  points.add({0, 0, nan});
  points.add({0, inf, 1});
  points.add({0.5, 0, 0});     // the origin
  points.add({0.5, 1e-6, 0});  // and that in another frame
  points.add({3e38, -3e38, 3e38});
  points.add({0, 0, 1.5});
  const CloudLabels& found = labeller.label(points.view(), {0.5, 0, 0}, scene.poses);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(found.labels[i], std::uint8_t(Label::unknown));
  EXPECT_EQ(found.labels[5], std::uint8_t(Label::clear));
}

/// Rays at corners and along edges are those that a careless test lets through.
TEST(TriangleTree, NoRaySlipsThroughAClosedMesh) {
  std::mt19937_64 random = seeded_random(422);
  const TriangleMesh mesh = sphere(1.0F, 40);
  const TriangleTree tree{PreparedMesh(mesh)};
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>(),
                   b = mesh.vertices[triangle[1]].cast<double>();
    const Vector3d from = 0.5 * random_direction(random);
    for (const Vector3d& at : {a, Vector3d(a + uniform(random, 0.0, 1.0) * (b - a))})
      ASSERT_NEAR(tree.first_hit(from, at - from), 1.0, 1e-3) << at.transpose();
  }
}

TEST(TriangleTree, ASmallHoleLetsNoPointOut) {
  std::mt19937_64 random = seeded_random(424);
  TriangleMesh mesh = sphere(0.5F, 24);
  mesh.triangles.erase(mesh.triangles.begin() + 500);
  const TriangleTree tree{PreparedMesh(mesh)};
  for (int i = 0; i < 20'000; ++i) {
    const double away = i % 2 == 0 ? uniform(random, 0.0, 0.45) : uniform(random, 0.87, 1.7);
    const Vector3d point = away * random_direction(random);
    ASSERT_EQ(tree.encloses(point), away < 0.5) << point.transpose();
  }
}

}  // namespace
}  // namespace penumbra::test
