// Closed meshes have no gaps: spheres, tori, noise and cuts as thin as Boolean operations leave, small and huge, near
// and far from the origin, through brute force and through structures.
#include "verify/watertight.h"

#include <algorithm>
#include <iostream>

#include <gtest/gtest.h>

#include "raygrain/families.h"
#include "raygrain/triangle.h"
#include "raygrain/verify.h"

#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "verify/compare.h"

namespace raygrain::test {
namespace {

using verification::crosses_evenly;
using verification::hits_in_order;
using verification::Oracle;

const std::vector<std::string> kStructures{
    "binary tree=SAH+ALL@spatial", "wide leaf=4", "wide tree=SAH+ALL@sweep batch=16",
    "accelerator ray_space=1 tree=SAH+ALL@binned local=PAH+ALL@spatial", "accelerator areas=0 batch=17"};

VerifyScene scene_of(const NamedMesh& family, uint64_t seed) {
  return {family.name, std::make_shared<const TriangleMesh>(family.mesh), areas_around(family.mesh, seed)};
}

template <class Body>
void for_closed_meshes(uint64_t seeds, const Body& body) {
  for (uint64_t seed = 0; seed < seed_count(seeds); ++seed)
    for (const NamedMesh& family : closed_mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      body(family, seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(ClosedMeshes, EveryEdgeIsUsedAsOftenInEitherDirection) {
  for_closed_meshes(2, [](const NamedMesh& family, uint64_t) {
    std::vector<std::pair<uint32_t, uint32_t>> forth, back;
    for (const auto& t : family.mesh.triangles)
      for (size_t k = 0; k < 3; ++k) {
        forth.emplace_back(t[k], t[(k + 1) % 3]);
        back.emplace_back(t[(k + 1) % 3], t[k]);
      }
    std::ranges::sort(forth);
    std::ranges::sort(back);
    ASSERT_EQ(forth, back);
    ASSERT_TRUE(family.closed);
  });
}

TEST(ClosedMeshes, NoRayFromInsideLeaves) {
  size_t rays = 0;
  const size_t per_mesh = seed_count(4) == 1 ? 30 : 150;
  for_closed_meshes(1, [&](const NamedMesh& family, uint64_t seed) {
    const VerifyScene scene = scene_of(family, seed);
    const Oracle oracle(family.mesh);
    RayGroup group{RayGroupKind::kFrom, family.inside, rays_from(family.inside, family.mesh, per_mesh, seed), true};
    for (const Ray& ray : group.rays) ASSERT_TRUE(is_hit(oracle.nearest(ray))) << verification::to_text(ray);
    rays += group.rays.size();
    const size_t count = group.rays.size();
    for (const std::string& name : kStructures) {
      SCOPED_TRACE(name);
      std::vector<Hit> nearest(count);
      std::vector<uint8_t> any(count), told(count);
      std::vector<float> until(count, kInf);
      for (const RayGroupKind kind : {RayGroupKind::kMixed, RayGroupKind::kFrom}) {
        group.kind = kind;
        std::ranges::fill(any, uint8_t{1});
        parse_structure(name).make(scene)(group, {nearest, any, told, until});
        for (size_t i = 0; i < count; ++i) {
          ASSERT_TRUE(same_bits(nearest[i], oracle.nearest(group.rays[i]))) << verification::to_text(group.rays[i]);
          ASSERT_EQ(any[i], 1);
        }
      }
    }
  });
  EXPECT_EQ(rays, seed_count(1) * 56 * per_mesh);
  std::cout << rays << " rays from inside\n";
}

// Lines both ways, and rays that start outside of everything; those that touch an edge exactly say nothing.
TEST(ClosedMeshes, LinesCrossAnEvenNumberOfTimes) {
  size_t lines = 0, asked = 0, crossings = 0;
  for_closed_meshes(4, [&](const NamedMesh& family, uint64_t seed) {
    const Oracle oracle(family.mesh);
    std::vector<Ray> rays = aimed_rays(family.mesh, 150, seed);
    for (const Ray& ray : extreme_rays(family.mesh, 100, seed)) rays.push_back(ray);
    for (const Ray& ray : rays) {
      ++asked;
      const std::optional<bool> even = crosses_evenly(oracle, ray);
      if (!even) continue;
      ASSERT_TRUE(*even) << verification::to_text(ray);
      ++lines;
      crossings += oracle.crossings(ray).count;
    }
  });
  EXPECT_GT(lines, asked / 3);
  EXPECT_GT(crossings, lines);
  std::cout << lines << " lines of " << asked << " touch no edge, " << crossings << " crossings\n";
}

/// Where brute force says that a line meets the mesh: the least triangle of each float t, ascending.
std::vector<Hit> hits_by_brute_force(const Oracle& oracle, const Ray& line) {
  return hits_in_order(
      [&](const RayGroup& group, const RayAnswers& answers) { answers.nearest[0] = oracle.nearest(group.rays[0]); },
      line);
}

// A walk along the line: every next search begins one float behind the last hit. The structures find every place where
// brute force does; and how many triangles are met at these places is even.
TEST(ClosedMeshes, WalksThroughStructuresFindEveryCrossing) {
  size_t steps = 0;
  for_closed_meshes(1, [&](const NamedMesh& family, uint64_t seed) {
    const VerifyScene scene = scene_of(family, seed);
    const Oracle oracle(family.mesh);
    std::vector<AnswerRays> structures;
    for (const std::string& name : kStructures) structures.push_back(parse_structure(name).make(scene));
    for (const Ray& ray : extreme_rays(family.mesh, seed_count(4) == 1 ? 10 : 40, seed + 7)) {
      if (!is_valid(ray)) continue;
      const std::vector<Hit> expected = hits_by_brute_force(oracle, ray);
      for (size_t s = 0; s < structures.size(); ++s) {
        const std::vector<Hit> found = hits_in_order(structures[s], ray);
        ASSERT_EQ(found.size(), expected.size()) << kStructures[s] << ", " << verification::to_text(ray);
        for (size_t i = 0; i < found.size(); ++i) ASSERT_TRUE(same_bits(found[i], expected[i])) << kStructures[s];
        steps += found.size();
      }
      if (crosses_evenly(oracle, ray).has_value()) {
        size_t met = 0;
        for (const Hit& hit : expected)
          for (size_t t = 0; t < family.mesh.triangle_count(); ++t) {
            const TriangleMesh& mesh = family.mesh;
            Hit same;
            met += intersect_triangle({ray.origin, ray.direction, hit.t, hit.t}, mesh.vertex(t, 0), mesh.vertex(t, 1),
                                      mesh.vertex(t, 2), same);
          }
        ASSERT_EQ(met % 2, 0u) << verification::to_text(ray);
      }
    }
  });
  EXPECT_GT(steps, 500u);
}

}  // namespace
}  // namespace raygrain::test
