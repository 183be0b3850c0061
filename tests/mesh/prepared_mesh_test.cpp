// SPDX-License-Identifier: Apache-2.0
#include "../support/shapes.hpp"
#include "../support/test.hpp"
#include "mesh_oracle.hpp"

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra::test {
namespace {

TriangleMesh ring(std::uint32_t rows, std::uint32_t columns) {
  return torus(rows, columns, 0.3, 0.1);
}

/// The triangles of one patch.
TriangleMesh mesh_of(const PreparedMesh& mesh, const SurfacePatch& patch) {
  TriangleMesh part{mesh.vertices, {}};
  for (const std::uint32_t i : patch.triangles) part.triangles.push_back(mesh.triangles[i]);
  return part;
}

TEST(PreparedMesh, RaysFromOutsideMeetOuterSidesFirstOrGoThroughHoles) {
  std::mt19937_64 random = seeded_random(311);
  std::uniform_real_distribution<double> near(-0.4, 0.4);
  int known = 0, backs = 0;
  for (int round = 0; round < samples(40); ++round) {
    TriangleMesh mesh = ring(48, 32);
    for (int i = 0; i < 1 + round % 6; ++i) {
      const auto victim = std::ptrdiff_t(random() % mesh.triangles.size());
      auto& t = mesh.triangles[std::size_t(victim)];
      if (random() % 3 == 0) std::swap(t[0], t[1]);
      if (random() % 2 == 0) mesh.triangles.erase(mesh.triangles.begin() + victim);
    }
    const PreparedMesh prepared(mesh);
    for (std::size_t number = 0; number < prepared.patches.size(); ++number) {
      const auto& [facing, holes] = prepared.orientations()[number];
      if (facing == Facing::unknown) continue;
      ++known;
      const TriangleMesh patch = mesh_of(prepared, prepared.patches[number]);
      for (int i = 0; i < 200; ++i) {
        // Half of the rays aim at a hole, where backs are to be seen.
        Vector3d aim(near(random), near(random), 0.3 * near(random));
        if (i % 2 == 0 && !holes.empty()) {
          const Ball& hole = holes[random() % holes.size()];
          aim = hole.centre + hole.radius * aim;
        }
        const Vector3d origin = 2.0 * random_direction(random);
        const Vector3d ray = aim - origin;
        const auto met = crossings(patch, origin, ray);
        const auto first = std::ranges::min_element(met, {}, &Crossing::t);
        if (first == met.end() || first->leaves == (facing == Facing::inwards)) continue;
        ++backs;
        EXPECT_TRUE(std::any_of(holes.begin(), holes.end(), [&](const Ball& hole) {
          return (hole.centre - origin).cross(ray).norm() <= hole.radius * ray.norm();
        }));
      }
    }
  }
  EXPECT_GT(known, samples(20));
  EXPECT_GT(backs, samples(100));
}

}  // namespace
}  // namespace penumbra::test
