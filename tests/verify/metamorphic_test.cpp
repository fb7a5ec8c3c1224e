// What must happen to the answers when a scene is said otherwise, and nothing else: each test predicts the answers
// about the new scene from brute force about the old one, bit by bit, and asks brute force, wide trees on every
// instruction set, and accelerators with areas about the new one.
//
// By the definition of a hit (docs/theory.md) t, u and v are quotients of determinants in real arithmetic, rounded
// once. So they are *the same bits* wherever the determinants keep their ratios exactly: axes permuted or mirrored, the
// corners' order reversed (u and v change places), vertices and origin scaled by a power of two (t scales, also exactly
// while it stays a normal number), moved by an offset that every coordinate takes exactly. Other triangles never change
// them. The triangle's number is the least of those with the same float t: it changes as the numbers do.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/build.h"
#include "raygrain/families.h"
#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "verify/compare.h"

namespace raygrain::test {
namespace {

std::vector<Hit> answers_of(const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(intersect_reference(mesh, ray));
  return hits;
}

/// The answers of everything about this scene are the predicted ones.
void expect_answers(const TriangleMesh& mesh, const std::vector<Ray>& rays, const std::vector<Hit>& predicted,
                    uint64_t seed) {
  const auto expect_same = [&](const std::vector<Hit>& found, const std::string& who) {
    for (size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(same_bits(found[i], predicted[i]))
          << who << ", ray " << i << " " << verification::to_text(rays[i]) << ": " << verification::to_text(found[i])
          << " instead of " << verification::to_text(predicted[i]);
  };
  ASSERT_NO_FATAL_FAILURE(expect_same(answers_of(mesh, rays), "brute force"));
  BuildOptions build;
  build.clip = [&](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh, i, box); };
  const Bvh binary = build_spatial(triangle_bounds(mesh), {}, build, nullptr);
  std::vector<Hit> found(rays.size());
  for (const Isa isa : supported_isas()) {
    WideBvh(binary, mesh, {.isa = isa}).intersect(rays, found);
    ASSERT_NO_FATAL_FAILURE(expect_same(found, name(isa)));
  }
  AcceleratorOptions options;
  options.space = seed % 2 == 0 ? LocalSpace::kRay : LocalSpace::kWorld;
  const Accelerator accelerator(mesh, areas_around(mesh, seed), options);
  accelerator.intersect(rays, found);
  ASSERT_NO_FATAL_FAILURE(expect_same(found, "accelerator"));
  for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(accelerator.occluded(rays[i]), is_hit(predicted[i])) << i;
}

/// body(mesh, rays, seed): meshes of every family, and rays of every kind about them.
template <class Body>
void for_scenes(uint64_t seeds, size_t rays, const Body& body) {
  if (seed_count(4) == 1) rays /= 8;
  for (uint64_t seed = 0; seed < seed_count(seeds); ++seed)
    for (const NamedMesh& family : mesh_families(seed)) {
      if (family.mesh.triangles.empty()) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      std::vector<Ray> all = aimed_rays(family.mesh, rays / 2, seed + 1);
      for (const Ray& ray : extreme_rays(family.mesh, rays / 2, seed + 2)) all.push_back(ray);
      body(family.mesh, all, seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

std::vector<uint32_t> shuffled(size_t count, Random& random) {
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

TEST(Metamorphic, PermutedTrianglesChangeNumbersAlone) {
  size_t changed = 0;
  for_scenes(1, 80, [&](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    Random random(seed);
    const std::vector<uint32_t> order = shuffled(mesh.triangle_count(), random);  // new number -> old one
    TriangleMesh permuted = mesh;
    for (size_t i = 0; i < order.size(); ++i) permuted.triangles[i] = mesh.triangles[order[i]];
    // Of all triangles at the nearest t the one that is first now.
    std::vector<Hit> predicted = answers_of(mesh, rays);
    for (size_t r = 0; r < rays.size(); ++r) {
      if (!is_hit(predicted[r])) continue;
      const Ray there{rays[r].origin, rays[r].direction, predicted[r].t, predicted[r].t};
      for (uint32_t i = 0; i < order.size(); ++i) {
        Hit hit;
        if (!intersect_triangle(there, mesh.vertex(order[i], 0), mesh.vertex(order[i], 1), mesh.vertex(order[i], 2),
                                hit))
          continue;
        changed += order[i] != predicted[r].triangle;
        hit.triangle = i;
        predicted[r] = hit;
        break;
      }
    }
    expect_answers(permuted, rays, predicted, seed);
  });
  EXPECT_GT(changed, 0u);  // ties did change hands
}

TEST(Metamorphic, PermutedAndMirroredAxesChangeNothing) {
  constexpr std::array<std::array<int, 3>, 5> kOrders{{{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for_scenes(1, 60, [&](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    Random random(seed);
    const auto& order = kOrders[random.below(kOrders.size())];
    const uint64_t mirrored = random.below(8);
    const auto moved = [&](Vec3 p) {
      Vec3 q{p[order[0]], p[order[1]], p[order[2]]};
      for (int k = 0; k < 3; ++k)
        if (mirrored >> k & 1) q[k] = -q[k];
      return q;
    };
    TriangleMesh turned = mesh;
    for (Vec3& vertex : turned.vertices) vertex = moved(vertex);
    std::vector<Ray> turned_rays = rays;
    for (Ray& ray : turned_rays) ray.origin = moved(ray.origin), ray.direction = moved(ray.direction);
    expect_answers(turned, turned_rays, answers_of(mesh, rays), seed);
  });
}

/// Can the number be scaled by this power of two and stay exact?
bool scales(float x, int power) {
  return std::ldexp(std::ldexp(x, power), -power) == x && std::isfinite(std::ldexp(x, power));
}
/// A normal number well within the range of floats, before and after.
bool is_moderate(float x) {
  return std::abs(x) > 0x1p-60f && std::abs(x) < 0x1p60f;
}

TEST(Metamorphic, PowersOfTwoScaleTAndNothingElse) {
  size_t compared = 0;
  for_scenes(1, 100, [&](const TriangleMesh& mesh, const std::vector<Ray>& all_rays, uint64_t seed) {
    for (const int power : {-20, 3, 33}) {
      const auto scaled = [&](Vec3 p) {
        return Vec3{std::ldexp(p.x, power), std::ldexp(p.y, power), std::ldexp(p.z, power)};
      };
      const auto is_exact = [&](Vec3 p) { return scales(p.x, power) && scales(p.y, power) && scales(p.z, power); };
      if (!std::ranges::all_of(mesh.vertices, is_exact)) continue;
      TriangleMesh larger = mesh;
      for (Vec3& vertex : larger.vertices) vertex = scaled(vertex);
      std::vector<Ray> rays;
      std::vector<Hit> predicted;
      for (Ray ray : all_rays) {
        ray.tmin = 0;  // so that a rounded t is on the same side of it
        ray.tmax = kInf;
        if (!is_valid(ray) || !is_exact(ray.origin)) continue;
        Hit hit = intersect_reference(mesh, ray);
        // What underflows or overflows is rounded otherwise; so nothing is predicted about it.
        if (is_hit(hit) && !is_moderate(hit.t)) continue;
        const double longest =
            std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
        if (!(longest > 0x1p-40 && longest < 0x1p40)) continue;
        hit.t = std::ldexp(hit.t, power);
        rays.push_back({scaled(ray.origin), ray.direction});
        predicted.push_back(hit);
        // The direction alone: the other way round.
        Ray longer = rays.back();
        longer.direction = scaled(longer.direction);
        if (!is_exact(ray.direction)) continue;
        rays.push_back(longer);
        predicted.push_back(hit);
        predicted.back().t = std::ldexp(hit.t, -power);
      }
      compared += rays.size();
      expect_answers(larger, rays, predicted, seed);
    }
  });
  EXPECT_GT(compared, 200u);
}

TEST(Metamorphic, DuplicatesChangeNumbersAsTheyAreCounted) {
  for_scenes(1, 60, [](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    const std::vector<Hit> before = answers_of(mesh, rays);
    TriangleMesh appended = mesh;
    appended.triangles.insert(appended.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    ASSERT_NO_FATAL_FAILURE(expect_answers(appended, rays, before, seed));
    TriangleMesh in_place = mesh;
    in_place.triangles.clear();
    for (const auto& triangle : mesh.triangles) in_place.triangles.insert(in_place.triangles.end(), 2, triangle);
    std::vector<Hit> predicted = before;
    for (Hit& hit : predicted)
      if (is_hit(hit)) hit.triangle *= 2;
    expect_answers(in_place, rays, predicted, seed);
  });
}

/// Both meshes as one; the second's numbers follow the first's.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto offset = static_cast<uint32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return both;
}

/// The nearer of the answers about two parts of a mesh; `number` gives the second's numbers.
template <class Number>
std::vector<Hit> merged(std::vector<Hit> a, const std::vector<Hit>& b, const Number& number) {
  for (size_t i = 0; i < a.size(); ++i) {
    Hit other = b[i];
    if (is_hit(other)) other.triangle = number(other.triangle);
    if (is_nearer(other, a[i])) a[i] = other;
  }
  return a;
}

// Boxes, centers and padding all change; answers only where a ray meets what was added.
TEST(Metamorphic, FarGeometryChangesWhatMeetsItAlone) {
  for_scenes(1, 60, [](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    const auto count = static_cast<uint32_t>(mesh.triangle_count());
    for (const float far : {1e4f, 1e12f, 1e37f}) {
      TriangleMesh added;
      added.vertices = {{far, far, -far}, {far * 1.01f, far, -far}, {far, far * 1.5f, far}, {-far, -far, -far}};
      added.triangles = {{0, 1, 2}, {0, 1, 3}};
      const std::vector<Hit> predicted =
          merged(answers_of(mesh, rays), answers_of(added, rays), [&](uint32_t i) { return i + count; });
      ASSERT_NO_FATAL_FAILURE(expect_answers(joined(mesh, added), rays, predicted, seed));
    }
  });
}

TEST(Metamorphic, ReversedWindingSwapsUAndV) {
  for_scenes(1, 80, [](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    TriangleMesh reversed = mesh;
    for (auto& triangle : reversed.triangles) std::swap(triangle[1], triangle[2]);
    std::vector<Hit> predicted = answers_of(mesh, rays);
    for (Hit& hit : predicted) std::swap(hit.u, hit.v);
    expect_answers(reversed, rays, predicted, seed);
  });
}

// The answers about two halves, merged by (t, number), are those about the whole; also where a search over one half is
// given the other's answer.
TEST(Metamorphic, SplitMeshesMergeToTheWhole) {
  for_scenes(1, 60, [](const TriangleMesh& mesh, const std::vector<Ray>& rays, uint64_t seed) {
    TriangleMesh halves[2] = {{mesh.vertices, {}}, {mesh.vertices, {}}};
    for (size_t i = 0; i < mesh.triangle_count(); ++i) halves[i % 2].triangles.push_back(mesh.triangles[i]);
    std::vector<Hit> even = answers_of(halves[0], rays);
    for (Hit& hit : even)
      if (is_hit(hit)) hit.triangle *= 2;
    const std::vector<Hit> predicted = merged(even, answers_of(halves[1], rays), [](uint32_t i) { return 2 * i + 1; });
    ASSERT_NO_FATAL_FAILURE(expect_answers(mesh, rays, predicted, seed));

    std::vector<uint32_t> odd_ids;
    for (uint32_t i = 1; i < mesh.triangle_count(); i += 2) odd_ids.push_back(i);
    std::vector<Bounds> boxes;
    for (const uint32_t i : odd_ids) boxes.push_back(triangle_bounds(mesh, i));
    Bvh odd = build_binned(boxes, {}, {});
    for (uint32_t& prim : odd.prims) prim = odd_ids[prim];
    const WideBvh wide(odd, mesh);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same_bits(wide.intersect(rays[i], even[i]), predicted[i])) << i;
      ASSERT_TRUE(same_bits(intersect(odd, mesh, rays[i], even[i]), predicted[i])) << i;
    }
  });
}

// Coordinates of few bits take a power of two exactly, and all differences stay as they were.
TEST(Metamorphic, ExactMovesChangeNothing) {
  size_t compared = 0;
  for_scenes(2, 120, [&](const TriangleMesh& mesh, const std::vector<Ray>& all_rays, uint64_t seed) {
    for (const Vec3 offset : {Vec3{1024, -2048, 512}, Vec3{-0x1p17f, 0, 0x1p16f}}) {
      const auto is_sum_exact = [&](Vec3 p) {
        const Vec3d sum = to_double(p) + to_double(offset);
        return to_double(to_float(sum)) == sum && sum - to_double(offset) == to_double(p);
      };
      if (!std::ranges::all_of(mesh.vertices, is_sum_exact)) continue;
      TriangleMesh moved = mesh;
      for (Vec3& vertex : moved.vertices) vertex = vertex + offset;
      std::vector<Ray> rays, old_rays;
      for (Ray ray : all_rays) {
        if (!is_valid(ray) || !is_sum_exact(ray.origin)) continue;
        old_rays.push_back(ray);
        ray.origin = ray.origin + offset;
        rays.push_back(ray);
      }
      compared += rays.size();
      ASSERT_NO_FATAL_FAILURE(expect_answers(moved, rays, answers_of(mesh, old_rays), seed));
    }
  });
  EXPECT_GT(compared, 50u);
}

}  // namespace
}  // namespace raygrain::test
