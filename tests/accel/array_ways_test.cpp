// Arrays and batches around the sizes at which they take another way, against brute force, and batches in many parts.
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"

#include "accel/bundles.h"
#include "accel/scenes.h"

namespace raygrain::test {
namespace {

constexpr Vec3 kLight{0.3f, -0.9f, 0.2f}, kLamp{0.1f, 0.2f, 0.3f}, kEye{9, 4, 1};

/// A sun, a lamp in all directions and a camera.
Accelerator make_scene(const TriangleMesh& mesh, Routing routing, LocalSpace space = LocalSpace::kNone) {
  const Bounds box = mesh_bounds(mesh);
  std::vector<InfluenceArea> areas{directional_light_area("sun", kLight, box)};
  for (const InfluenceArea& area : point_light_areas("lamp", kLamp, box)) areas.push_back(area);
  areas.push_back(camera_area("camera", kEye, center(box), 70, 1.5f, box));
  AcceleratorOptions options;
  options.routing = routing;
  options.space = space;
  return Accelerator(mesh, areas, options);
}

Vec3 somewhere(Random& random, double reach) {
  const auto x = static_cast<float>(random.uniform(-reach, reach)),
             y = static_cast<float>(random.uniform(-reach, reach));
  return {x, y, static_cast<float>(random.uniform(-reach, reach))};
}

std::vector<Vec3> places(size_t count, Random& random) {
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) points.push_back(somewhere(random, 3));
  return points;
}

/// Rays of every kind that a batch call could have, rays that only look like them, and others, in no order.
std::vector<Ray> mixed_rays(size_t count, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 p = somewhere(random, 3);
    const Vec3 nearly{std::nextafter(kLight.x, 1.0f), kLight.y, kLight.z};
    const Ray kinds[] = {
        {p, -kLight, 0, kInf}, {p, kLight, 0, kInf},       {p, kLamp - p, 0, 1},    {kLamp, p, 0, kInf},
        {kEye, p - kEye},      {p, p * 0.7f, 0, 1},        {p, -kLight, 0, 2},      {p, -kLight, 0.25f},
        {p, -nearly},          {p, (kLamp - p) * 2, 0, 1}, {p, kLamp - p, 0, 0.5f}, {kEye, p - kEye, 0, 9},
        {p, {}, 0, kInf}};
    // Most are of the first six kinds.
    rays.push_back(kinds[random.below(8) != 0 ? random.below(6) : random.below(std::size(kinds))]);
  }
  return rays;
}

void expect_array(const Accelerator& scene, std::span<const Ray> rays, unsigned threads) {
  SCOPED_TRACE(std::to_string(rays.size()) + " rays");
  std::vector<Hit> hits(rays.size(), Hit{1, 1, 1, 1}), counted(rays.size());
  std::vector<uint8_t> flags(rays.size(), 7), counted_flags(rays.size());
  AcceleratorCounters counters, any;
  scene.intersect(rays, hits, threads);
  scene.intersect(rays, counted, threads, &counters);
  scene.occluded(rays, flags, threads);
  scene.occluded(rays, counted_flags, threads, &any);
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = intersect_reference(scene.mesh(), rays[i]);
    ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof expected), 0) << "ray " << i;
    ASSERT_EQ(flags[i], is_hit(expected) ? 1 : 0) << "ray " << i;
  }
  EXPECT_TRUE(counted == hits && counted_flags == flags);
  for (const AcceleratorCounters& c : {counters, any}) {
    EXPECT_EQ(c.rays, rays.size());
    uint64_t covered = 0;
    for (const AreaUse& use : c.areas) covered += use.covered;
    EXPECT_EQ(covered, c.covered);
  }
}

constexpr size_t kSizes[] = {1,
                             2,
                             3,
                             kLeastRays - 1,
                             kLeastRays,
                             kLeastRays + 1,
                             kLeastDividedRays - 1,
                             kLeastDividedRays,
                             kLeastDividedRays + 1,
                             Bundles::kLeastMixed - 1,
                             Bundles::kLeastMixed,
                             Bundles::kLeastMixed + 1,
                             1023,
                             1024,
                             1025,
                             3000};

TEST(ArrayWays, MixedArraysOfAllSizesEqualBruteForce) {
  const TriangleMesh mesh = random_mesh(40, 5);
  for (const Routing routing : {Routing::kCheapest, Routing::kAreas})
    for (const LocalSpace space : {LocalSpace::kNone, LocalSpace::kWorld}) {
      const Accelerator scene = make_scene(mesh, routing, space);
      Random random(7);
      const std::vector<Ray> rays = mixed_rays(3000, random);
      for (const size_t size : kSizes) expect_array(scene, std::span(rays).first(size), size % 2 == 0 ? 2 : 1);
      std::vector<Ray> of_sun;
      for (const Ray& ray : rays) of_sun.push_back({ray.origin, -kLight});
      for (const size_t size : kSizes) expect_array(scene, std::span(of_sun).first(size), 1);
    }
}

TEST(ArrayWays, BatchesOfAllSizesEqualBruteForce) {
  const TriangleMesh mesh = random_mesh(40, 5);
  for (const Routing routing : {Routing::kCheapest, Routing::kAreas}) {
    const Accelerator scene = make_scene(mesh, routing);
    Random random(9);
    const std::vector<Vec3> all = places(3000, random);
    for (const size_t size : kSizes) {
      SCOPED_TRACE(std::to_string(size) + " rays");
      const std::span<const Vec3> points = std::span(all).first(size);
      std::vector<uint8_t> sun(size, 7), lamp(size, 7);
      std::vector<Hit> first(size), seen(size);
      scene.occluded(points, -kLight, sun, 1);
      scene.intersect(points, kLight, first, 1);
      scene.occluded_towards(points, kLamp, lamp, 1);
      for (size_t i = 0; i < size; ++i) {
        ASSERT_EQ(sun[i] != 0, occluded_reference(mesh, {points[i], -kLight})) << "ray " << i;
        ASSERT_EQ(lamp[i] != 0, occluded_reference(mesh, {points[i], kLamp - points[i], 0, 1})) << "ray " << i;
        ASSERT_EQ(first[i], intersect_reference(mesh, {points[i], kLight})) << "ray " << i;
      }
      for (const Vec3 eye : {kEye, kLamp}) {
        scene.intersect_from(eye, points, seen, 1);
        for (size_t i = 0; i < size; ++i)
          ASSERT_EQ(seen[i], intersect_reference(mesh, {eye, points[i]})) << "ray " << i;
      }
    }
  }
}

/// A ray is of a bundle if it is bit for bit the ray of the batch call, -0 and all.
TEST(ArrayWays, BundlesHoldJustTheRaysOfBatchCalls) {
  const TriangleMesh mesh = random_mesh(40, 5);
  const Accelerator scene = make_scene(mesh, Routing::kAreas);
  BatchCoverages coverages;
  const std::span<const Coverage> all = scene.coverages();
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (i == 0) coverages.planes.push_back({all[i], i});
    if (i == 1) coverages.eyes.push_back({kLamp, {}});
    if (i > 0 && i + 1 < all.size()) coverages.eyes[0].coverages.push_back({all[i], i});
  }
  coverages.eyes.push_back({kEye, {{all.back(), static_cast<uint32_t>(all.size() - 1)}}});
  Random random(3);
  const std::vector<Ray> rays = mixed_rays(1024, random);
  for (const bool any : {true, false}) {
    const Bundles bundles(coverages, any, rays);
    ASSERT_EQ(bundles.size(), any ? 2u : 3u);
    size_t held = 0;
    for (size_t k = 0; k < bundles.size(); ++k)
      for (const uint32_t number : bundles.rays(k)) {
        const Ray made = bundles.shared(k).ray(any, bundles.points()[number]);
        ASSERT_EQ(std::memcmp(&made, &rays[number], sizeof made), 0) << "ray " << number;
        ++held;
      }
    const auto is_of = [&](const Ray& ray) {
      const Shared shared[] = {{any ? -kLight : kLight, false}, {kLamp, true}, {kEye, true}};
      return std::ranges::any_of(shared, [&](const Shared& s) {
        const Ray made = s.ray(any, s.is_point && !any ? ray.direction : ray.origin);
        return std::memcmp(&made, &ray, sizeof made) == 0;
      });
    };
    EXPECT_EQ(held, static_cast<size_t>(std::ranges::count_if(rays, is_of)));
    EXPECT_EQ(bundles.others().size() + held, rays.size());
  }
}

TEST(ArrayWays, NegativeZerosAreNoRaysOfABatch) {
  const TriangleMesh mesh = random_mesh(40, 5);
  const Vec3 down{0, 0, -1};
  AcceleratorOptions options;
  options.routing = Routing::kAreas;
  options.space = LocalSpace::kNone;
  const Accelerator scene(mesh, {directional_light_area("sun", down, mesh_bounds(mesh))}, options);
  const BatchCoverages coverages{{{scene.coverages()[0], 0}}, {}};
  Random random(8);
  std::vector<Ray> rays;
  for (const Vec3 point : places(Bundles::kLeastMixed, random))
    rays.push_back({point, rays.size() % 2 == 0 ? Vec3{0, 0, 1} : Vec3{-0.0f, 0, 1}});
  const Bundles bundles(coverages, true, rays);
  EXPECT_EQ(bundles.size(), 1u);
  EXPECT_EQ(bundles.others().size(), rays.size() / 2);
  expect_array(scene, rays, 1);
}

/// Counted right: all rays of batch calls in a mixed array are answered by coverage, and no others.
TEST(ArrayWays, CoverageAnswersTheRaysOfBatchCallsInArrays) {
  TriangleMesh mesh;
  add_floor(mesh, 0, 4);
  add_floor(mesh, 2, 1);
  const Vec3 lamp{30, 0, 1};
  const InfluenceArea at_lamp{"lamp", PointArea{lamp, {-1, 0, 0}, {0, 0, 1}, 120, 120, 0.01f, 100}};
  AcceleratorOptions options;
  options.routing = Routing::kAreas;
  options.space = LocalSpace::kNone;
  const Accelerator scene(mesh, {directional_light_area("sun", {0, 0, -1}, mesh_bounds(mesh)), at_lamp}, options);
  Random random(2);
  std::vector<Ray> rays;
  for (size_t i = 0; i < 1024; ++i) {
    const Vec3 p{somewhere(random, 1).x, somewhere(random, 1).y, 1};
    rays.push_back(i % 4 == 0 ? Ray{p, {0, 0, 1}} : i % 4 == 1 ? Ray{p, lamp - p, 0, 1} : Ray{p, {0, 1, 0.1f}, 0, 1});
  }
  AcceleratorCounters counters;
  std::vector<uint8_t> flags(rays.size());
  scene.occluded(rays, flags, 1, &counters);
  EXPECT_EQ(counters.areas, (std::vector<AreaUse>{{256, 0, 0}, {256, 0, 0}}));
  EXPECT_EQ(counters.covered, 512u);
  EXPECT_EQ(counters.global_searches, 512u);
  expect_array(scene, rays, 1);
}

/// More rays than two tasks take, whatever their order: one by one they find the same, and a sample is asked of brute
/// force.
TEST(ArrayWays, BatchesInManyPartsAreAnsweredAsSingleRays) {
  const TriangleMesh mesh = random_mesh(12, 4);
  const Accelerator scene = make_scene(mesh, Routing::kAreas);
  const size_t count = (size_t{1} << 20) + 77;
  Random random(21);
  const std::vector<Vec3> points = places(count, random);
  std::vector<uint8_t> flags(count);
  std::vector<Hit> hits(count);
  const auto is_sample = [](size_t i) { return i % 1009 == 0; };
  const auto expect_flags = [&](auto ray_of) {
    for (size_t i = 0; i < count; ++i) {
      const Ray ray = ray_of(points[i]);
      ASSERT_EQ(flags[i] != 0, scene.occluded(ray)) << "ray " << i;
      if (is_sample(i)) {
        ASSERT_EQ(flags[i] != 0, occluded_reference(mesh, ray)) << "ray " << i;
      }
    }
  };
  const auto expect_hits = [&](auto ray_of) {
    for (size_t i = 0; i < count; ++i) {
      const Ray ray = ray_of(points[i]);
      ASSERT_EQ(hits[i], scene.intersect(ray)) << "ray " << i;
      if (is_sample(i)) {
        ASSERT_EQ(hits[i], intersect_reference(mesh, ray)) << "ray " << i;
      }
    }
  };
  scene.occluded(points, -kLight, flags, 2);
  expect_flags([](Vec3 p) { return Ray{p, -kLight}; });
  scene.intersect(points, kLight, hits, 1);
  expect_hits([](Vec3 p) { return Ray{p, kLight}; });
  scene.occluded_towards(points, kLamp, flags, 2);
  expect_flags([](Vec3 p) { return Ray{p, kLamp - p, 0, 1}; });
  scene.intersect_from(kLamp, points, hits, 2);
  expect_hits([](Vec3 p) { return Ray{kLamp, p}; });
}

}  // namespace
}  // namespace raygrain::test
