// Ten million rays in one call, against the same rays one by one and brute force about some of them; at full scale
// only.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"

#include "accel/scenes.h"
#include "base/parallel.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain::test {
namespace {

constexpr Vec3 kLight{0.3f, -0.9f, 0.2f}, kLamp{0.1f, 0.2f, 0.3f};
constexpr size_t kRays = 10'000'019;  // the last piece is no whole one, however a call is divided

Accelerator make_scene() {
  const TriangleMesh mesh = random_mesh(300, 4);
  const Bounds box = mesh_bounds(mesh);
  std::vector<InfluenceArea> areas{directional_light_area("sun", kLight, box)};
  for (const InfluenceArea& area : point_light_areas("lamp", kLamp, box)) areas.push_back(area);
  AcceleratorOptions options;
  options.routing = Routing::kAreas;  // coverage, whatever it costs
  options.space = LocalSpace::kNone;
  return Accelerator(mesh, areas, options);
}

std::vector<Vec3> places() {
  Random random(21);
  std::vector<Vec3> points;
  points.reserve(kRays);
  const auto somewhere = [&] { return static_cast<float>(random.uniform(-3, 3)); };
  while (points.size() < kRays) {
    const float x = somewhere(), y = somewhere();
    points.push_back({x, y, somewhere()});
  }
  return points;
}

/// How many answers are wrong; the rays are compared on all threads.
size_t count_wrong(const std::function<bool(size_t)>& is_right) {
  std::vector<uint8_t> wrong(kRays);
  parallel_for(kRays, 4096, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) wrong[i] = !is_right(i);
  });
  return static_cast<size_t>(std::ranges::count(wrong, 1));
}

bool is_sample(size_t i) {
  return i % 101 == 0;
}

/// `call` answers all points in one call; `ray_of` says which ray that is about a point.
template <class Call, class RayOf>
void expect_any(const Accelerator& scene, std::span<const Vec3> points, const Call& call, const RayOf& ray_of) {
  std::vector<uint8_t> flags(kRays, 7);
  AcceleratorCounters counters;
  call(flags, &counters);
  EXPECT_EQ(counters.rays, kRays);
  EXPECT_GT(counters.covered, kRays * 9 / 10);
  EXPECT_EQ(count_wrong([&](size_t i) {
              const Ray ray = ray_of(points[i]);
              return flags[i] == (scene.occluded(ray) ? 1 : 0) &&
                     (!is_sample(i) || flags[i] == (occluded_reference(scene.mesh(), ray) ? 1 : 0));
            }),
            0u);
  std::vector<uint8_t> again(kRays, 7);
  call(again, nullptr);
  EXPECT_TRUE(again == flags);
}

template <class Call, class RayOf>
void expect_nearest(const Accelerator& scene, std::span<const Vec3> points, const Call& call, const RayOf& ray_of) {
  std::vector<Hit> hits(kRays, Hit{7, 7, 7, 7});
  AcceleratorCounters counters;
  call(hits, &counters);
  EXPECT_EQ(counters.rays, kRays);
  EXPECT_GT(counters.covered, kRays / 3);  // the others start behind what the area sees first
  EXPECT_EQ(count_wrong([&](size_t i) {
              const Ray ray = ray_of(points[i]);
              return same_bits(hits[i], scene.intersect(ray)) &&
                     (!is_sample(i) || same_bits(hits[i], intersect_reference(scene.mesh(), ray)));
            }),
            0u);
  std::vector<Hit> again(kRays, Hit{7, 7, 7, 7});
  call(again, nullptr);
  EXPECT_TRUE(std::ranges::equal(again, hits, same_bits));
}

TEST(LargeBatches, TenMillionRaysInACallAreAnsweredAsSingleRays) {
  if (!is_full_scale()) GTEST_SKIP() << "at full scale only";
  const Accelerator scene = make_scene();
  const std::vector<Vec3> points = places();
  using Count = AcceleratorCounters*;
  expect_any(
      scene, points, [&](auto& flags, Count count) { scene.occluded(points, -kLight, flags, 0, count); },
      [](Vec3 p) {
        return Ray{p, -kLight};
      });
  expect_nearest(
      scene, points, [&](auto& hits, Count count) { scene.intersect(points, kLight, hits, 0, count); },
      [](Vec3 p) {
        return Ray{p, kLight};
      });
  expect_any(
      scene, points, [&](auto& flags, Count count) { scene.occluded_towards(points, kLamp, flags, 0, count); },
      [](Vec3 p) {
        return Ray{p, kLamp - p, 0, 1};
      });
  expect_nearest(
      scene, points, [&](auto& hits, Count count) { scene.intersect_from(kLamp, points, hits, 0, count); },
      [](Vec3 p) {
        return Ray{kLamp, p};
      });
}

/// Of any kind, so that the call has to find out which are a sun's and which a lamp's.
TEST(LargeBatches, TenMillionRaysOfArraysAreAnsweredAsSingleRays) {
  if (!is_full_scale()) GTEST_SKIP() << "at full scale only";
  const Accelerator scene = make_scene();
  const std::vector<Vec3> points = places();
  std::vector<Ray> rays;
  rays.reserve(kRays);
  for (const Vec3 p : points)
    rays.push_back(rays.size() % 3 == 0   ? Ray{p, -kLight}
                   : rays.size() % 3 == 1 ? Ray{p, kLamp - p, 0, 1}
                                          : Ray{p, kLight});
  std::vector<uint8_t> flags(kRays, 7);
  std::vector<Hit> hits(kRays, Hit{7, 7, 7, 7});
  AcceleratorCounters any, nearest;
  scene.occluded(rays, flags, 0, &any);
  scene.intersect(rays, hits, 0, &nearest);
  EXPECT_GT(any.covered, kRays / 2);
  EXPECT_GT(nearest.covered, kRays / 10);
  EXPECT_EQ(count_wrong([&](size_t i) {
              return flags[i] == (scene.occluded(rays[i]) ? 1 : 0) && same_bits(hits[i], scene.intersect(rays[i])) &&
                     (!is_sample(i) || same_bits(hits[i], intersect_reference(scene.mesh(), rays[i])));
            }),
            0u);
}

}  // namespace
}  // namespace raygrain::test
