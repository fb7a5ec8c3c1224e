// The definition of a hit, checked against cases worked out by hand, against an independent program for small integers,
// and against identities that hold for the definition but for few wrong formulas.
#include "raygrain/triangle.h"

#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/random.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

using Intersector = bool (*)(const Ray&, Vec3, Vec3, Vec3, Hit&);
constexpr Intersector kIntersectors[] = {intersect_triangle, intersect_triangle_exact};

bool same_bits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

struct Case {
  const char* name;
  Ray ray;
  std::array<Vec3, 3> corners;
  bool is_hit;
  float t, u, v;
};

constexpr float kHuge = 0x1.fffffep127f;

// Upright rays through the triangle (0,0,z), (4,0,z), (0,4,z) and others.
const std::array<Vec3, 3> kFlat{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}};
const Case kCases[] = {
    {"inside", {{1, 2, 0}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0.5f},
    {"behind the start", {{1, 2, 2}, {0, 0, 1}}, kFlat, false, 0, 0, 0},
    {"behind the start, allowed", {{1, 2, 3}, {0, 0, 1}, -kInf}, kFlat, true, -2, 0.25f, 0.5f},
    {"outside", {{3, 2, 0}, {0, 0, 1}}, kFlat, false, 0, 0, 0},
    {"on edge ab", {{1, 0, 0}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0},
    {"on edge bc", {{1, 3, 0}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0.75f},
    {"on edge ca", {{0, 1, 0}, {0, 0, 2}}, kFlat, true, 0.5f, 0, 0.25f},
    {"beside edge bc by one step", {{1, 0x1.800002p1f, 0}, {0, 0, 1}}, kFlat, false, 0, 0, 0},
    {"beside edge ab by the least step", {{1, -0x1p-149f, 0}, {0, 0, 1}}, kFlat, false, 0, 0, 0},
    {"at a", {{0, 0, 0}, {0, 0, 1}}, kFlat, true, 1, 0, 0},
    {"at b", {{4, 0, 0}, {0, 0, 1}}, kFlat, true, 1, 1, 0},
    {"at c", {{0, 4, 0}, {0, 0, 1}}, kFlat, true, 1, 0, 1},
    {"from a corner", {{4, 0, 1}, {1, 5, 1}}, kFlat, true, 0, 1, 0},
    {"starts inside it", {{1, 1, 1}, {3, -1, 1}}, kFlat, true, 0, 0.25f, 0.25f},
    {"in its plane", {{-1, 1, 1}, {1, 0, 0}}, kFlat, false, 0, 0, 0},
    {"in its plane, along an edge", {{-1, 0, 1}, {1, 0, 0}}, kFlat, false, 0, 0, 0},
    {"parallel to its plane", {{-1, 1, 0}, {1, 0, 0}}, kFlat, false, 0, 0, 0},
    {"a point", {{0, 0, 0}, {0, 0, 1}}, {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}}, false, 0, 0, 0},
    {"a segment", {{1, 0, 0}, {0, 0, 1}}, {{{0, 0, 1}, {4, 0, 1}, {2, 0, 1}}}, false, 0, 0, 0},
    {"a repeated corner", {{1, 0, 0}, {0, 0, 1}}, {{{0, 0, 1}, {4, 0, 1}, {4, 0, 1}}}, false, 0, 0, 0},
    {"tmax before it", {{1, 2, 0}, {0, 0, 1}, 0, 0x1.fffffep-1f}, kFlat, false, 0, 0, 0},
    {"tmax at it", {{1, 2, 0}, {0, 0, 1}, 0, 1}, kFlat, true, 1, 0.25f, 0.5f},
    {"tmin at it", {{1, 2, 0}, {0, 0, 1}, 1, 1}, kFlat, true, 1, 0.25f, 0.5f},
    {"tmin behind it", {{1, 2, 0}, {0, 0, 1}, 0x1.000002p0f}, kFlat, false, 0, 0, 0},
    {"tmin above tmax", {{1, 2, 0}, {0, 0, 1}, 2, 0}, kFlat, false, 0, 0, 0},
    {"a third of the way", {{1, 2, 0}, {0, 0, 3}}, kFlat, true, 0x1.555556p-2f, 0.25f, 0.5f},
    // t = 1 + 2^-24, half way between 1 and 1 + 2^-23: the even one; then a little more; then the next half.
    {"tie to even, down", {{1, 2, -0x1p-24f}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0.5f},
    {"above the tie", {{1, 2, -0x1.000002p-24f}, {0, 0, 1}}, kFlat, true, 0x1.000002p0f, 0.25f, 0.5f},
    {"below the tie", {{1, 2, -0x1.fffffep-25f}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0.5f},
    {"tie to even, up", {{1, 2, -0x1.8p-23f}, {0, 0, 1}}, kFlat, true, 0x1.000004p0f, 0.25f, 0.5f},
    {"a tie within tmax after rounding", {{1, 2, -0x1p-24f}, {0, 0, 1}, 0, 1}, kFlat, true, 1, 0.25f, 0.5f},
    {"rounds up to a power of two", {{1, 2, 0x1p-26f}, {0, 0, 1}}, kFlat, true, 1, 0.25f, 0.5f},
    {"overflows to infinity", {{1, 2, -0x1p100f}, {0, 0, 0x1p-100f}}, kFlat, true, kInf, 0.25f, 0.5f},
    {"overflows beyond tmax", {{1, 2, -0x1p100f}, {0, 0, 0x1p-100f}, 0, kHuge}, kFlat, false, 0, 0, 0},
    {"overflows below", {{1, 2, 0x1p100f}, {0, 0, 0x1p-100f}, -kInf}, kFlat, true, -kInf, 0.25f, 0.5f},
    {"underflows to zero", {{1, 2, 0x1.fffffep-1f}, {0, 0, 0x1p127f}}, kFlat, true, 0, 0.25f, 0.5f},
    {"underflows to positive zero", {{1, 2, 0x1.000002p0f}, {0, 0, 0x1p127f}}, kFlat, true, 0, 0.25f, 0.5f},
    {"least denormal", {{1, 2, 0x1.fffff8p-1f}, {0, 0, 0x1p127f}}, kFlat, true, 0x1p-149f, 0.25f, 0.5f},
    {"denormal tie to even", {{1, 2, 0x1.fffff4p-1f}, {0, 0, 0x1p127f}}, kFlat, true, 0x1p-148f, 0.25f, 0.5f},
    {"denormal triangle",
     {{0x1p-149f, 0x1p-149f, -1}, {0, 0, 1}},
     {{{0, 0, 0}, {0x1p-147f, 0, 0}, {0, 0x1p-147f, 0}}},
     true,
     1,
     0.25f,
     0.25f},
    {"denormal direction", {{1, 2, 0}, {0, 0, 0x1p-149f}, 0, kHuge}, kFlat, false, 0, 0, 0},
    {"largest floats",
     {{0, 0, -kHuge}, {0, 0, kHuge}},
     {{{-kHuge, -kHuge, kHuge}, {kHuge, -kHuge, kHuge}, {-kHuge, kHuge, kHuge}}},
     true,
     2,
     0.5f,
     0.5f},
};

TEST(Triangle, CasesWorkedOutByHand) {
  for (const Case& c : kCases)
    for (const Intersector intersect : kIntersectors) {
      SCOPED_TRACE(std::string(c.name) + (intersect == intersect_triangle ? ", fast" : ", exact"));
      Hit hit{-7, -8, -9, 10};
      ASSERT_EQ(intersect(c.ray, c.corners[0], c.corners[1], c.corners[2], hit), c.is_hit);
      const Hit expected = c.is_hit ? Hit{c.t, c.u, c.v, 10} : Hit{-7, -8, -9, 10};
      EXPECT_EQ(hit, expected) << hit.t << ' ' << hit.u << ' ' << hit.v;
      EXPECT_FALSE(hit.t == 0 && std::signbit(hit.t));
    }
}

// With coordinates of at most 20 the determinants are small integers, exact in double; and a quotient of integers below
// 2^27 is no closer to the middle of two floats than a double's rounding, unless it is the middle.
bool intersect_small_integers(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit) {
  const Vec3d d = to_double(ray.direction), o = to_double(ray.origin);
  const Vec3d p = to_double(a) - o, q = to_double(b) - o, r = to_double(c) - o;
  const double weights[] = {dot(d, cross(q, r)), dot(d, cross(r, p)), dot(d, cross(p, q))};
  const double sum = weights[0] + weights[1] + weights[2];
  for (const double weight : weights)
    if (sum == 0 || weight * sum < 0) return false;
  const auto t = static_cast<float>(dot(p, cross(q, r)) / sum);
  if (t < ray.tmin || t > ray.tmax) return false;
  hit.t = t;
  hit.u = static_cast<float>(weights[1] / sum);
  hit.v = static_cast<float>(weights[2] / sum);
  return true;
}

TEST(Triangle, SmallIntegers) {
  Random random(1);
  size_t hits = 0, edges = 0;
  const auto point = [&](uint64_t size) {
    const auto coordinate = [&] { return static_cast<float>(random.below(2 * size + 1)) - static_cast<float>(size); };
    const float x = coordinate(), y = coordinate();
    return Vec3{x, y, coordinate()};
  };
  const uint64_t rounds = test::seed_count(400000);
  for (uint64_t i = 0; i < rounds; ++i) {
    const uint64_t size = 1 + random.below(20);
    const Ray ray{point(size), point(size), random.below(2) ? 0 : -kInf, random.below(4) ? kInf : 1};
    if (!is_valid(ray)) continue;
    const Vec3 a = point(size), b = point(size), c = point(size);
    Hit expected;
    const bool is_hit = intersect_small_integers(ray, a, b, c, expected);
    hits += is_hit;
    edges += is_hit && (expected.u == 0 || expected.v == 0);
    for (const Intersector intersect : kIntersectors) {
      Hit hit;
      ASSERT_EQ(intersect(ray, a, b, c, hit), is_hit) << i;
      ASSERT_EQ(hit, expected) << i;
    }
  }
  EXPECT_GT(hits, rounds / 20);
  EXPECT_GT(edges, rounds / 400);
}

struct Pair {
  Ray ray;
  Vec3 a, b, c;
};

// Rays aimed at single triangles of every family.
template <class Body>
void for_pairs(uint64_t seed, size_t triangles, size_t rays, const Body& body) {
  Random random(seed);
  for (const test::NamedMesh& family : test::mesh_families(seed)) {
    SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
    if (family.mesh.triangles.empty()) continue;
    for (size_t i = 0; i < triangles; ++i) {
      const size_t triangle = random.below(family.mesh.triangle_count());
      const TriangleMesh one{
          {family.mesh.vertex(triangle, 0), family.mesh.vertex(triangle, 1), family.mesh.vertex(triangle, 2)},
          {{0, 1, 2}}};
      for (const Ray& ray : test::aimed_rays(one, rays, random.next()))
        if (is_valid(ray)) body(Pair{ray, one.vertices[0], one.vertices[1], one.vertices[2]});
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

void expect_same(const Pair& p, size_t& hits) {
  Hit fast, exact;
  const bool is_fast_hit = intersect_triangle(p.ray, p.a, p.b, p.c, fast);
  const bool is_exact_hit = intersect_triangle_exact(p.ray, p.a, p.b, p.c, exact);
  hits += is_exact_hit;
  ASSERT_EQ(is_fast_hit, is_exact_hit);
  ASSERT_TRUE(same_bits(fast.t, exact.t)) << fast.t << ' ' << exact.t;
  ASSERT_TRUE(same_bits(fast.u, exact.u)) << fast.u << ' ' << exact.u;
  ASSERT_TRUE(same_bits(fast.v, exact.v)) << fast.v << ' ' << exact.v;
}

TEST(Triangle, FastEqualsExactOnAimedRays) {
  size_t pairs = 0, hits = 0;
  const uint64_t seeds = test::seed_count(6);
  for (uint64_t seed = 0; seed < seeds; ++seed)
    for_pairs(seed, 30, 300, [&](const Pair& pair) {
      ++pairs;
      expect_same(pair, hits);
    });
  EXPECT_GT(pairs, seeds * 190000);
  EXPECT_GT(hits, pairs / 4);
}

TEST(Triangle, FastEqualsExactOnAllPairs) {
  size_t pairs = 0, hits = 0;
  const uint64_t seeds = test::seed_count(4);
  for (uint64_t seed = 10; seed < 10 + seeds; ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      const TriangleMesh& mesh = family.mesh;
      for (const Ray& ray : test::aimed_rays(mesh, 90, seed))
        for (size_t i = 0; i < mesh.triangle_count() && is_valid(ray); ++i, ++pairs)
          ASSERT_NO_FATAL_FAILURE(expect_same({ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)}, hits));
    }
  EXPECT_GT(pairs, seeds * 300000);
  EXPECT_GT(hits, seeds * 3000);
}

// Corners that differ by the last bits only, seen from afar: the double-precision filter can decide nothing.
TEST(Triangle, FastEqualsExactAtTheLimitOfPrecision) {
  Random random(5);
  size_t hits = 0;
  const auto near_one = [&] { return 1 + static_cast<float>(random.below(8)) * 0x1p-23f; };
  const auto point = [&](float scale) {
    const float x = near_one(), y = near_one();
    return Vec3{x, y, near_one()} * scale;
  };
  const uint64_t rounds = test::seed_count(200000);
  for (uint64_t i = 0; i < rounds; ++i) {
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(250)) - 125);
    const Vec3 origin = random.below(2) ? point(scale) : point(-scale);
    const Vec3 a = point(scale), b = point(scale), c = point(scale);
    const Ray ray{origin, random.below(2) ? point(1) : a - origin, -kInf};
    if (!is_valid(ray)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_same({ray, a, b, c}, hits));
  }
  EXPECT_GT(hits, rounds / 20);
}

// What the definition promises about other ways to say the same thing, bit for bit.
void expect_identities(const Pair& p) {
  for (const Intersector intersect : kIntersectors) {
    Hit abc, bca, cab, acb;
    const bool is_hit = intersect(p.ray, p.a, p.b, p.c, abc);
    ASSERT_EQ(intersect(p.ray, p.b, p.c, p.a, bca), is_hit);
    ASSERT_EQ(intersect(p.ray, p.c, p.a, p.b, cab), is_hit);
    ASSERT_EQ(intersect(p.ray, p.a, p.c, p.b, acb), is_hit);
    ASSERT_EQ(bca, (Hit{abc.t, abc.v, cab.u}));
    ASSERT_EQ(cab, (Hit{abc.t, bca.v, abc.u}));
    ASSERT_EQ(acb, (Hit{abc.t, abc.v, abc.u}));

    const auto turned = [](Vec3 x) { return Vec3{x.y, x.z, x.x}; };
    Hit hit;
    const Ray turned_ray{turned(p.ray.origin), turned(p.ray.direction), p.ray.tmin, p.ray.tmax};
    ASSERT_EQ(intersect(turned_ray, turned(p.a), turned(p.b), turned(p.c), hit), is_hit);
    ASSERT_EQ(hit, abc);

    const Ray mirrored{-p.ray.origin, -p.ray.direction, p.ray.tmin, p.ray.tmax};
    hit = {};
    ASSERT_EQ(intersect(mirrored, -p.a, -p.b, -p.c, hit), is_hit);
    ASSERT_EQ(hit, abc);

    const Ray backwards{p.ray.origin, -p.ray.direction, -p.ray.tmax, -p.ray.tmin};
    hit = {};
    ASSERT_EQ(intersect(backwards, p.a, p.b, p.c, hit), is_hit);
    ASSERT_EQ(hit, is_hit ? (Hit{-abc.t, abc.u, abc.v}) : Hit{});
    if (!is_hit) continue;

    ASSERT_GE(abc.u, 0);
    ASSERT_GE(abc.v, 0);
    ASSERT_LE(abc.u, 1);
    ASSERT_LE(abc.v, 1);
    hit = {};
    ASSERT_TRUE(intersect({p.ray.origin, p.ray.direction, abc.t, abc.t}, p.a, p.b, p.c, hit));
    ASSERT_EQ(hit, abc);
    const float before = std::nextafter(abc.t, -kInf), after = std::nextafter(abc.t, kInf);
    const Ray ends_before{p.ray.origin, p.ray.direction, -kInf, before};
    const Ray starts_after{p.ray.origin, p.ray.direction, after, kInf};
    ASSERT_FALSE(before < abc.t && intersect(ends_before, p.a, p.b, p.c, hit));
    ASSERT_FALSE(abc.t < after && intersect(starts_after, p.a, p.b, p.c, hit));
  }
}

TEST(Triangle, Identities) {
  for (uint64_t seed = 20; seed < 20 + test::seed_count(2); ++seed) for_pairs(seed, 10, 60, expect_identities);
}

}  // namespace
}  // namespace raygrain
