// Batches of rays that share a direction or a point, through whole accelerators, against brute force.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "base/random.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

constexpr Vec3 kLight{0.3f, -0.9f, 0.2f};

/// A sun, a lamp in all directions, and a camera, where finite areas exist around the mesh.
std::vector<InfluenceArea> areas_of(const Bounds& box, Vec3 lamp, Vec3 eye) {
  std::vector<InfluenceArea> areas{directional_light_area("sun", kLight, box)};
  for (const InfluenceArea& area : point_light_areas("lamp", lamp, box)) areas.push_back(area);
  areas.push_back(camera_area("camera", eye, center(box), 50, 1.5f, box));
  return areas;
}

struct Scene {
  TriangleMesh mesh;
  Vec3 lamp, eye;
  std::vector<Vec3> points, directions;
};

Scene make_scene(const TriangleMesh& mesh, size_t rays, Random& random) {
  const Bounds box = mesh_bounds(mesh);
  const Vec3d lo = to_double(box.lo), size = to_double(extent(box)), middle = to_double(center(box));
  const double reach = length(size);
  const auto somewhere = [&](double around) {
    return to_float(lo + Vec3d{size.x * random.uniform(-around, 1 + around),
                               size.y * random.uniform(-around, 1 + around),
                               size.z * random.uniform(-around, 1 + around)});
  };
  Scene scene{mesh, somewhere(0), to_float(middle + Vec3d{reach, 0.4 * reach, 0.1 * reach}), {}, {}};
  for (size_t i = 0; i < rays; ++i) {
    const Vec3 corner = mesh.vertex(random.below(mesh.triangle_count()), static_cast<int>(random.below(3)));
    scene.points.push_back(random.below(2) == 0 ? corner : somewhere(0.2));
    scene.directions.push_back((random.below(2) == 0 ? corner : somewhere(0.5)) - scene.eye);
  }
  scene.points[0] = {std::nanf(""), 0, 0};
  scene.directions[0] = {};
  return scene;
}

void expect_batches(const Accelerator& accelerator, const Scene& scene, size_t count, unsigned threads) {
  SCOPED_TRACE(std::to_string(count) + " rays, " + std::to_string(threads) + " threads");
  const std::span<const Vec3> points = std::span(scene.points).first(count);
  const std::span<const Vec3> directions = std::span(scene.directions).first(count);
  const TriangleMesh& mesh = scene.mesh;
  std::vector<uint8_t> flags(count, 7), towards(count, 7);
  std::vector<Hit> hits(count, Hit{1, 1, 1, 1}), from(count, Hit{1, 1, 1, 1});
  for (const Vec3 direction : {-kLight, kLight, Vec3{0.1f, 0.7f, -0.4f}}) {
    accelerator.occluded(points, direction, flags, threads);
    accelerator.intersect(points, direction, hits, threads);
    for (size_t i = 0; i < count; ++i) {
      const Ray ray{points[i], direction, 0, kInf};
      const Hit expected = intersect_reference(mesh, ray);
      ASSERT_EQ(flags[i], is_hit(expected) ? 1 : 0) << "ray " << i;
      ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof expected), 0) << "ray " << i;
    }
  }
  for (const Vec3 point : {scene.lamp, scene.eye, mesh.vertex(0, 0)}) {
    accelerator.occluded_towards(points, point, towards, threads);
    for (size_t i = 0; i < count; ++i)
      ASSERT_EQ(towards[i] != 0, occluded_reference(mesh, {points[i], point - points[i], 0, 1})) << "ray " << i;
  }
  for (const Vec3 eye : {scene.eye, scene.lamp}) {
    accelerator.intersect_from(eye, directions, from, threads);
    for (size_t i = 0; i < count; ++i) {
      const Hit expected = intersect_reference(mesh, {eye, directions[i], 0, kInf});
      ASSERT_EQ(std::memcmp(&from[i], &expected, sizeof expected), 0) << "ray " << i;
    }
  }
}

bool has_areas(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  for (const Vec3 p : {box.lo, box.hi})
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) < 0x1p60f)) return false;
  return !mesh.triangles.empty();
}

TEST(Batch, AgreesWithTheOracleInAllSizesAndOnAllThreads) {
  for (uint64_t seed = 0; seed < test::seed_count(1); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      if (!has_areas(family.mesh)) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      Random random(seed + 7);
      const Scene scene = make_scene(family.mesh, 300, random);
      AcceleratorOptions options;
      options.coverage->order = seed % 2 == 0 ? CoverageOrder::kByCell : CoverageOrder::kByTile;
      const Accelerator accelerator(scene.mesh, areas_of(mesh_bounds(scene.mesh), scene.lamp, scene.eye), options);
      for (const size_t count : {size_t{1}, size_t{7}, size_t{8}, size_t{9}, size_t{300}})
        expect_batches(accelerator, scene, count, count % 2 == 0 ? 2 : 1);
      if (testing::Test::HasFatalFailure()) return;
    }
}

/// Many rays over several tasks, scattered and in order: all the same as one by one.
TEST(Batch, IsTheSameForAnyOrderAndAnyNumberOfThreads) {
  const std::vector<test::NamedMesh> families = test::mesh_families(3);
  const auto closed =
      std::ranges::find_if(families, [](const test::NamedMesh& m) { return m.closed && has_areas(m.mesh); });
  Random random(11);
  const Scene scene = make_scene(closed->mesh, 20000, random);
  const std::vector<InfluenceArea> areas = areas_of(mesh_bounds(scene.mesh), scene.lamp, scene.eye);
  const Accelerator usual(scene.mesh, areas);
  std::vector<Vec3> sorted = scene.points;
  std::ranges::sort(sorted, {}, [](Vec3 p) { return std::isnan(p.x) ? -kInf : p.x; });
  for (const std::vector<Vec3>& points : {scene.points, sorted}) {
    const size_t count = points.size();
    std::vector<uint8_t> sun(count), lamp(count), expected_sun(count), expected_lamp(count);
    std::vector<Hit> first(count), expected_first(count);
    usual.intersect(points, kLight, expected_first, 1);
    for (size_t i = 0; i < count; ++i) {
      expected_sun[i] = usual.occluded({points[i], -kLight, 0, kInf});
      expected_lamp[i] = usual.occluded({points[i], scene.lamp - points[i], 0, 1});
    }
    for (const CoverageOrder order : kCoverageOrders) {
      SCOPED_TRACE(name(order));
      AcceleratorOptions options;
      options.coverage->order = order;
      const Accelerator accelerator(scene.mesh, areas, options);
      for (const unsigned threads : {1u, 2u, 0u}) {
        accelerator.intersect(points, kLight, first, threads);
        accelerator.occluded(points, -kLight, sun, threads);
        accelerator.occluded_towards(points, scene.lamp, lamp, threads);
        ASSERT_TRUE(first == expected_first && sun == expected_sun && lamp == expected_lamp);
      }
    }
  }
}

TEST(Batch, RefusesAnswersOfAnotherSizeAndTakesNoRays) {
  const Scene scene{test::mesh_families(1).front().mesh, {}, {}, {}, {}};
  const Accelerator accelerator(scene.mesh);
  std::vector<uint8_t> flags(1);
  std::vector<Hit> hits(1);
  EXPECT_THROW(accelerator.occluded(std::vector<Vec3>{}, kLight, flags), Error);
  EXPECT_THROW(accelerator.intersect(std::vector<Vec3>{}, kLight, hits), Error);
  EXPECT_THROW(accelerator.occluded_towards(std::vector<Vec3>{}, kLight, flags), Error);
  EXPECT_THROW(accelerator.intersect_from(kLight, std::vector<Vec3>{}, hits), Error);
  accelerator.occluded(std::vector<Vec3>{}, kLight, {});
  accelerator.intersect_from(kLight, std::vector<Vec3>{}, {});
}

}  // namespace
}  // namespace raygrain
