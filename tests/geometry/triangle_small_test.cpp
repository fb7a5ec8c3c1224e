// The definition in 128-bit integers against the definition in integers of any size.
#include "geometry/triangle_small.h"

#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/triangle.h"

#include "base/random.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

struct Counts {
  size_t asked = 0, fitting = 0, hits = 0;
};

/// Where the integers fit the answer is the same, bit for bit; and intersect_triangle's always is.
void expect_same(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Counts& counts) {
  Hit small, fast, exact;
  const bool is_hit = intersect_triangle_exact(ray, a, b, c, exact);
  ASSERT_EQ(intersect_triangle(ray, a, b, c, fast), is_hit);
  ASSERT_EQ(fast, exact);
  ++counts.asked;
  counts.hits += is_hit;
  const std::optional<bool> answer = intersect_triangle_small(ray, a, b, c, small);
  if (!answer) return;
  ++counts.fitting;
  ASSERT_EQ(*answer, is_hit);
  ASSERT_EQ(small, exact);
  ASSERT_FALSE(small.t == 0 && std::signbit(small.t));
}

// Numbers of few bits with exponents of their own: whatever fits into 128 bits, and what does not fit by a little.
TEST(TriangleSmall, EqualsTheDefinitionWhereExponentsDiffer) {
  Random random(6);
  Counts counts;
  const uint64_t rounds = test::seed_count(200000);
  for (uint64_t i = 0; i < rounds; ++i) {
    const uint64_t bits = 1 + random.below(12), spread = random.below(40), ray_spread = random.below(100);
    const auto number = [&](uint64_t exponents) {
      const auto mantissa = static_cast<float>(static_cast<int>(random.below(uint64_t{2} << bits)) - (1 << bits));
      return std::ldexp(mantissa, -static_cast<int>(random.below(exponents + 1)));
    };
    const auto point = [&](uint64_t exponents) {
      const float x = number(exponents), y = number(exponents);
      return Vec3{x, y, number(exponents)};
    };
    const Vec3 a = point(spread), b = point(spread), c = point(spread), origin = point(spread);
    Ray ray{origin, point(ray_spread), -kInf};
    if (random.below(2)) ray.direction = a - origin;
    if (random.below(4) == 0) ray.direction[static_cast<int>(random.below(3))] = number(ray_spread);
    if (!is_valid(ray)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_same(ray, a, b, c, counts)) << i;
  }
  EXPECT_GT(counts.hits, counts.asked / 50);
  EXPECT_GT(counts.fitting, counts.asked / 3);
  EXPECT_LT(counts.fitting, counts.asked);
}

TEST(TriangleSmall, EqualsTheDefinitionOnEveryFamily) {
  Counts counts;
  for (uint64_t seed = 0; seed < test::seed_count(1); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      const TriangleMesh& mesh = family.mesh;
      for (const Ray& ray : extreme_rays(mesh, 90, seed))
        for (size_t i = 0; i < mesh.triangle_count() && is_valid(ray); i += 3)
          ASSERT_NO_FATAL_FAILURE(expect_same(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), counts));
    }
  EXPECT_GT(counts.fitting, counts.asked * 3 / 4);
}

// Ties, denormal quotients, overflow and underflow of t.
TEST(TriangleSmall, RoundsAsTheDefinitionDoes) {
  Random random(7);
  Counts counts;
  const uint64_t rounds = test::seed_count(100000);
  for (uint64_t i = 0; i < rounds; ++i) {
    const int exponent = static_cast<int>(random.below(240)) - 125, away = static_cast<int>(random.below(26));
    const auto whole = [&] { return static_cast<float>(random.below(64)); };
    const Vec3 a{0, 0, std::ldexp(whole(), exponent)}, b{std::ldexp(64.0f, exponent), 0, a.z},
        c{0, std::ldexp(64.0f, exponent), a.z};
    const Vec3 origin{std::ldexp(whole() / 2, exponent), std::ldexp(whole() / 2, exponent),
                      -std::ldexp(whole(), exponent - away)};
    const Ray ray{origin, {0, 0, std::ldexp(1 + whole(), static_cast<int>(random.below(250)) - 125)}, -kInf};
    if (!is_valid(ray)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_same(ray, a, b, c, counts)) << i;
  }
  EXPECT_GT(counts.hits, counts.asked / 2);
  EXPECT_EQ(counts.fitting, counts.asked);
}

}  // namespace
}  // namespace raygrain
