// What accelerators count, against rays of known kinds.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"

#include "accel/scenes.h"

namespace raygrain::test {
namespace {

constexpr Vec3 kUp{0, 0, 1}, kDown{0, 0, -1}, kLamp{30, 0, 1};
constexpr size_t kNowhere = 0, kLampArea = 1, kSun = 2;

/// A floor at z = 0 under a roof at z = 2; an area far from both, a lamp beside them, and a sun above.
Accelerator make_scene(Routing routing = Routing::kAreas) {
  TriangleMesh mesh;
  add_floor(mesh, 0, 4);
  add_floor(mesh, 2, 1);
  const InfluenceArea nowhere{"nowhere", PlaneArea{{1000, 0, 0}, {0.6f, 0.8f, 0}, {0, 0, 1}, 1, 1, 1}};
  const InfluenceArea lamp{"lamp", PointArea{kLamp, {-1, 0, 0}, {0, 0, 1}, 120, 120, 0.01f, 100}};
  AcceleratorOptions options;
  options.routing = routing;
  return Accelerator(mesh, {nowhere, lamp, directional_light_area("sun", kDown, mesh_bounds(mesh))}, options);
}

/// Places in [-1, 1]^2 at a height.
Vec3 place(Random& random, float z) {
  const auto x = static_cast<float>(random.uniform(-1, 1));
  return {x, static_cast<float>(random.uniform(-1, 1)), z};
}

template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
}

AcceleratorCounters count_any(const Accelerator& scene, std::span<const Ray> rays, unsigned threads) {
  AcceleratorCounters counters;
  std::vector<uint8_t> flags(rays.size()), plain(rays.size());
  scene.occluded(rays, flags, threads, &counters);
  scene.occluded(rays, plain, threads);
  EXPECT_EQ(flags, plain);
  return counters;
}

TEST(Counters, TellTheKindsOfAMixedArray) {
  const Accelerator scene = make_scene();
  ASSERT_TRUE(scene.coverages()[kLampArea].is_useful() && scene.coverages()[kSun].is_useful());
  ASSERT_FALSE(scene.coverages()[kNowhere].is_useful());
  Random random(3);
  std::vector<Ray> rays;
  const auto add = [&](size_t count, float z, auto direction_at, float tmax) {
    for (size_t i = 0; i < count; ++i) {
      const Vec3 origin = place(random, z);
      rays.push_back({origin, direction_at(origin), 0, tmax});
    }
  };
  const auto slanted = [](Vec3) { return Vec3{0.02f, 0.03f, 1}; };
  add(
      1000, 1, [](Vec3) { return kUp; }, kInf);  // to the sun
  add(
      200, 1, [](Vec3 origin) { return kLamp - origin; }, 1);  // to the lamp
  add(700, 0.5f, slanted, 0.25f);                              // near the sun's, end in its region
  add(300, 2, slanted, kInf);                                  // ... and leave it
  add(
      500, 1,
      [](Vec3) {
        return Vec3{0, 1, 0};
      },
      kInf);  // nobody's
  add(
      13, 1, [](Vec3) { return Vec3{}; }, kInf);  // invalid
  for (size_t i = 1900; i < 2200; ++i) rays[i].origin.z = 2.0001f;
  shuffle(rays, random);
  AcceleratorCounters first = count_any(scene, rays, 1);
  EXPECT_EQ(first.rays, 2713u);
  EXPECT_EQ(first.invalid_rays, 13u);
  EXPECT_EQ(first.covered, 1200u);
  EXPECT_EQ(first.global_searches, 800u);
  EXPECT_EQ(first.areas, (std::vector<AreaUse>{{}, {200, 0, 0}, {1000, 700, 300}}));
  for (const unsigned threads : {2u, 0u}) EXPECT_EQ(count_any(scene, rays, threads), first);
  AcceleratorCounters twice = first, singly;
  twice.add(first);
  EXPECT_EQ(twice.areas, (std::vector<AreaUse>{{}, {400, 0, 0}, {2000, 1400, 600}}));
  for (const Ray& ray : rays) scene.occluded(ray, &singly);
  EXPECT_EQ(singly.areas, first.areas);
}

/// So few rays of areas that the array goes to the global tree as a whole: counters tell of that way.
TEST(Counters, TellOfTheWayWithoutThem) {
  const Accelerator scene = make_scene();
  Random random(5);
  std::vector<Ray> rays;
  for (size_t i = 0; i < 1024; ++i) rays.push_back({place(random, 1), i < 40 ? kUp : Vec3{0, 1, 0}});
  shuffle(rays, random);
  const AcceleratorCounters any = count_any(scene, rays, 1);
  EXPECT_EQ(any.global_searches, 1024u);
  EXPECT_EQ(any.areas, (std::vector<AreaUse>{{}, {}, {0, 0, 40}}));
  AcceleratorCounters nearest;
  std::vector<Hit> hits(rays.size());
  scene.intersect(rays, hits, 1, &nearest);
  EXPECT_EQ(nearest.global_searches, 1024u);
  EXPECT_EQ(nearest.areas, any.areas);
  EXPECT_GT(any.global.box_tests, 0u);
}

/// Batches of `points` by ask(points, threads, counters): the same for any number of threads.
template <class Ask>
AcceleratorCounters count_batch(const std::vector<Vec3>& points, const Ask& ask) {
  AcceleratorCounters first;
  ask(points, 1, &first);
  for (const unsigned threads : {2u, 0u}) {
    AcceleratorCounters counters;
    ask(points, threads, &counters);
    EXPECT_EQ(counters, first);
  }
  EXPECT_EQ(first.rays, points.size());
  return first;
}

class BatchCounters : public testing::Test {
 protected:
  BatchCounters() {
    for (size_t i = 0; i < 5000; ++i) above_.push_back(place(random_, 3));
    for (size_t i = 0; i < 3000; ++i) between_.push_back(place(random_, 1));
    both_ = above_;
    both_.insert(both_.end(), between_.begin(), between_.end());
    both_.resize(both_.size() + 7, Vec3{std::nanf(""), 0, 0});
    shuffle(both_, random_);
  }

  AcceleratorCounters any(const std::vector<Vec3>& points, Vec3 direction) {
    return count_batch(points, [&](std::span<const Vec3> some, unsigned threads, AcceleratorCounters* counters) {
      std::vector<uint8_t> flags(some.size());
      scene_.occluded(some, direction, flags, threads, counters);
    });
  }

  Accelerator scene_ = make_scene();
  Random random_{9};
  std::vector<Vec3> above_, between_, both_;
};

TEST_F(BatchCounters, TowardsALight) {
  const AcceleratorCounters sun = any(both_, kUp);
  EXPECT_EQ(sun.covered, 8000u);
  EXPECT_EQ(sun.invalid_rays, 7u);
  EXPECT_EQ(sun.global_searches, 0u);
  EXPECT_EQ(sun.areas, (std::vector<AreaUse>{{}, {}, {8000, 0, 0}}));
  const AcceleratorCounters nobody = any(both_, {0, 1, 0});
  EXPECT_EQ(nobody.covered, 0u);
  EXPECT_EQ(nobody.global_searches, 8000u);
  EXPECT_EQ(nobody.areas, std::vector<AreaUse>(3));
  EXPECT_GT(nobody.global.box_tests, 0u);
}

/// Rays that start below the roof are not its coverage's, but the local tree ends them at the floor.
TEST_F(BatchCounters, AlongALight) {
  const AcceleratorCounters sun =
      count_batch(both_, [&](std::span<const Vec3> some, unsigned threads, AcceleratorCounters* counters) {
        std::vector<Hit> hits(some.size());
        scene_.intersect(some, kDown, hits, threads, counters);
      });
  size_t covered = 0;
  for (const Vec3 point : both_) covered += scene_.coverages()[kSun].intersect({point, kDown}).has_value() ? 1 : 0;
  EXPECT_GE(covered, 5000u);
  EXPECT_LT(covered, 8000u);
  EXPECT_EQ(sun.areas, (std::vector<AreaUse>{{}, {}, {covered, 8000 - covered, 0}}));
  EXPECT_EQ(sun.covered + sun.local_searches, 8000u);
  EXPECT_EQ(sun.invalid_rays, 7u);
}

TEST_F(BatchCounters, ToAndFromAPoint) {
  for (const Vec3 point : {kLamp, Vec3{0, 30, 1}}) {
    const AcceleratorCounters towards =
        count_batch(both_, [&](std::span<const Vec3> some, unsigned threads, AcceleratorCounters* counters) {
          std::vector<uint8_t> flags(some.size());
          scene_.occluded_towards(some, point, flags, threads, counters);
        });
    std::vector<Vec3> directions;
    for (const Vec3 place : both_) directions.push_back(place - point);
    const AcceleratorCounters from =
        count_batch(directions, [&](std::span<const Vec3> some, unsigned threads, AcceleratorCounters* counters) {
          std::vector<Hit> hits(some.size());
          scene_.intersect_from(point, some, hits, threads, counters);
        });
    const uint64_t covered = point == kLamp ? 8000 : 0;
    for (const AcceleratorCounters& c : {towards, from}) {
      EXPECT_EQ(c.areas, (std::vector<AreaUse>{{}, {covered, 0, 0}, {}}));
      EXPECT_EQ(c.global_searches, 8000 - covered);
      EXPECT_EQ(c.invalid_rays, 7u);
    }
  }
}

/// Six areas about one lamp, each with the rays of its own window.
TEST(Counters, TellTheWindowsOfALamp) {
  TriangleMesh mesh;
  for (const float z : {-4.0f, 4.0f}) add_floor(mesh, z, 4);
  const std::vector<InfluenceArea> windows = point_light_areas("lamp", {0, 0, 0}, mesh_bounds(mesh));
  const Accelerator scene(mesh, windows);
  Random random(4);
  std::vector<Vec3> points;
  for (size_t i = 0; i < 900; ++i) {
    const Vec3 p = place(random, 3);
    points.push_back(i < 200 ? p : i < 500 ? Vec3{p.x, p.y, -3} : Vec3{3, p.x, p.y});
  }
  shuffle(points, random);
  std::vector<uint8_t> flags(points.size());
  std::vector<Hit> hits(points.size());
  AcceleratorCounters towards, from;
  scene.occluded_towards(points, {0, 0, 0}, flags, 1, &towards);
  scene.intersect_from({0, 0, 0}, points, hits, 1, &from);
  for (const AcceleratorCounters& c : {towards, from}) {
    EXPECT_EQ(c.covered, 900u);
    ASSERT_EQ(c.areas.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
      const std::string& name = windows[i].name;
      const uint64_t expected = name == "lamp+z" ? 200 : name == "lamp-z" ? 300 : name == "lamp+x" ? 400 : 0;
      EXPECT_EQ(c.areas[i], (AreaUse{expected, 0, 0})) << name;
    }
  }
}

}  // namespace
}  // namespace raygrain::test
