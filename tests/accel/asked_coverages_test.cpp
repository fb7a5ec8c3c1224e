// Which coverages a ray asks, and in which order.
#include "accel/asked_coverages.h"

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/trace.h"

#include "base/random.h"
#include "support/triangle_soup.h"

namespace raygrain {
namespace {

constexpr Vec3 kLamp{50, 52, 48}, kOther{20, 70, 10};

/// A sun, a lamp's six frusta, a camera, and a second lamp.
struct Fixture {
  std::shared_ptr<const TriangleMesh> mesh = std::make_shared<const TriangleMesh>(test::triangle_soup(3000, 5));
  std::vector<InfluenceArea> areas;
  std::vector<AreaGeometry> geometries;
  std::vector<Coverage> coverages;
  std::vector<uint8_t> covers;

  explicit Fixture(bool has_other) {
    const Bounds box = mesh_bounds(*mesh);
    areas.push_back(directional_light_area("sun", {0.3f, -0.9f, 0.2f}, box));
    for (const InfluenceArea& area : point_light_areas("lamp", kLamp, box)) areas.push_back(area);
    areas.push_back(camera_area("camera", {200, 80, 10}, center(box), 50, 1.5f, box));
    if (has_other)
      for (const InfluenceArea& area : point_light_areas("other", kOther, box)) areas.push_back(area);
    for (const InfluenceArea& area : areas) geometries.emplace_back(area);
    coverages = Coverage::of_areas(mesh, areas, {});
    covers.assign(areas.size(), 1);
  }
};

Vec3 somewhere(Random& random) {
  const double x = random.uniform(0, 100), y = random.uniform(0, 100);
  return to_float(Vec3d{x, y, random.uniform(0, 100)});
}

/// Areas of point lights that were asked until one answered.
struct Asked {
  size_t lamp = 0, other = 0;
  std::optional<bool> answer;
};

Asked ask_all(const AskedCoverages& coverages, const Ray& ray) {
  Asked asked;
  asked.answer = coverages.first_answer(ray, [&](const Coverage& coverage, uint32_t area) {
    asked.lamp += area >= 1 && area <= 6;
    asked.other += area >= 8;
    return coverage.occluded(ray);
  });
  return asked;
}

TEST(AskedCoverages, RaysToALampAskTheFrustumThatTheyAreIn) {
  for (const bool has_other : {false, true}) {
    const Fixture scene(has_other);
    const AskedCoverages asked(scene.coverages, scene.geometries, scene.covers, EyeEnd::kTowards);
    Random random(11);
    size_t answered = 0, elsewhere = 0, of_others = 0;
    for (size_t i = 0; i < 2000; ++i) {
      const Vec3 origin = somewhere(random);
      const Asked of_lamp = ask_all(asked, {origin, kLamp - origin, 0, 1});
      if (!of_lamp.answer) continue;
      ++answered;
      EXPECT_EQ(of_lamp.lamp, 1u) << "ray " << i;
      EXPECT_EQ(*of_lamp.answer, occluded_reference(*scene.mesh, {origin, kLamp - origin, 0, 1})) << "ray " << i;
      elsewhere += of_lamp.other;
      if (!has_other) continue;
      const Asked of_other = ask_all(asked, {origin, kOther - origin, 0, 1});
      EXPECT_EQ(of_other.lamp, 0u) << "ray " << i;
      if (!of_other.answer) continue;
      ++of_others;
      EXPECT_EQ(of_other.other, 1u) << "ray " << i;
    }
    EXPECT_GT(answered, 1800u);
    EXPECT_EQ(of_others > 1800, has_other);
    EXPECT_EQ(elsewhere, 0u);
  }
}

TEST(AskedCoverages, RaysFromALampAskTheFrustumThatTheyAreIn) {
  const Fixture scene(false);
  const AskedCoverages asked(scene.coverages, scene.geometries, scene.covers, EyeEnd::kFrom);
  Random random(12);
  size_t answered = 0;
  for (size_t i = 0; i < 2000; ++i) {
    const Ray ray{kLamp, somewhere(random) - kLamp};
    size_t frusta = 0;
    const auto hit = asked.first_answer(ray, [&](const Coverage& coverage, uint32_t area) {
      frusta += area >= 1 && area <= 6;
      return coverage.intersect(ray);
    });
    if (!hit) continue;
    ++answered;
    EXPECT_EQ(frusta, 1u) << "ray " << i;
    EXPECT_EQ(hit->triangle, intersect_reference(*scene.mesh, ray).triangle) << "ray " << i;
  }
  EXPECT_GT(answered, 1800u);
}

TEST(AskedCoverages, OnlyThoseThatCover) {
  Fixture scene(false);
  scene.covers.assign(scene.covers.size(), 0);
  const Ray ray{{10, 20, 30}, kLamp - Vec3{10, 20, 30}, 0, 1};
  EXPECT_EQ(ask_all({scene.coverages, scene.geometries, scene.covers, EyeEnd::kTowards}, ray).lamp, 0u);
  scene.covers[3] = 1;
  EXPECT_EQ(ask_all({scene.coverages, scene.geometries, scene.covers, EyeEnd::kTowards}, ray).lamp, 1u);
}

TEST(AskedCoverages, FacesOfDirections) {
  EXPECT_EQ(AskedCoverages::face_of({3, 2, -1}), 0u);
  EXPECT_EQ(AskedCoverages::face_of({-3, 2, -1}), 1u);
  EXPECT_EQ(AskedCoverages::face_of({3, 4, -1}), 2u);
  EXPECT_EQ(AskedCoverages::face_of({3, -4, -1}), 3u);
  EXPECT_EQ(AskedCoverages::face_of({3, -4, 1e30f}), 4u);
  EXPECT_EQ(AskedCoverages::face_of({0, 1e-40f, -1e-39f}), 5u);
  EXPECT_LT(AskedCoverages::face_of({kInf, -std::nanf(""), 0}), 6u);
}

}  // namespace
}  // namespace raygrain
