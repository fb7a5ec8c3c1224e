#include "raygrain/area.h"

#include <functional>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "geometry/area_support.h"

namespace raygrain {
namespace {

using test::point_inside;
using test::random_area;
using test::random_vector;

struct BadArea {
  const char* field;
  InfluenceArea area;
};

template <class Shape>
InfluenceArea with(const std::function<void(Shape&)>& change) {
  Shape shape;
  change(shape);
  return {"bad", shape};
}

std::vector<BadArea> bad_areas() {
  using Plane = PlaneArea;
  using Point = PointArea;
  std::vector<BadArea> bad{
      {"center", with<Plane>([](Plane& p) { p.center.x = NAN; })},
      {"direction", with<Plane>([](Plane& p) { p.direction = {}; })},
      {"direction", with<Plane>([](Plane& p) { p.direction.y = kInf; })},
      {"up", with<Plane>([](Plane& p) { p.up.z = NAN; })},
      {"half_width", with<Plane>([](Plane& p) { p.half_width = 0; })},
      {"half_height", with<Plane>([](Plane& p) { p.half_height = -1; })},
      {"half_height", with<Plane>([](Plane& p) { p.half_height = kInf; })},
      {"depth", with<Plane>([](Plane& p) { p.depth = NAN; })},
      {"eye", with<Point>([](Point& p) { p.eye.x = kInf; })},
      {"forward", with<Point>([](Point& p) { p.forward = {}; })},
      {"fov_x", with<Point>([](Point& p) { p.fov_x = 0; })},
      {"fov_x", with<Point>([](Point& p) { p.fov_x = NAN; })},
      {"fov_y", with<Point>([](Point& p) { p.fov_y = 180; })},
      {"near_z", with<Point>([](Point& p) { p.near_z = 0; })},
      {"near_z", with<Point>([](Point& p) { p.near_z = p.far_z; })},
      {"far_z", with<Point>([](Point& p) { p.far_z = kInf; })},
  };
  InfluenceArea wide{"bad", PlaneArea{}, 1};
  bad.push_back({"tolerance", wide});
  wide.tolerance = -0.1f;
  bad.push_back({"tolerance", wide});
  return bad;
}

TEST(Area, WrongAreasAreRefusedWithTheField) {
  for (const BadArea& bad : bad_areas()) {
    SCOPED_TRACE(bad.field);
    try {
      validate(bad.area, "areas[3]");
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kBadArea);
      EXPECT_EQ(error.where, "areas[3]");
      EXPECT_EQ(error.message.rfind(bad.field, 0), 0u) << error.what();
    }
    EXPECT_THROW(AreaGeometry{bad.area}, Error);
  }
}

TEST(Area, VerticalDirectionsAndParallelUpAreFine) {
  for (const float sign : {1.0f, -1.0f}) {
    PlaneArea plane;
    plane.direction = {0, sign, 0};
    const AreaGeometry area({"vertical", plane});
    EXPECT_TRUE(is_finite(area.frame().right));
    EXPECT_EQ(area.hit_probability({{-9, -9, -9}, {9, 9, 9}}), 1);
    EXPECT_TRUE(area.serves({{0, sign * 0.5f, 0}, {0, sign, 0}}));
    PointArea point;
    point.forward = {0, sign, 0};
    point.up = {};
    EXPECT_EQ(AreaGeometry({"vertical", point}).hit_probability({{-200, -200, -200}, {200, 200, 200}}), 1);
  }
}

TEST(Area, ToleranceZeroAcceptsTheExactDirectionInBothSenses) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    InfluenceArea influence = random_area(random, true);
    influence.tolerance = 0;
    const AreaGeometry area(influence);
    const Vec3 direction = std::get<PlaneArea>(influence.shape).direction;
    const Vec3d unit = normalized(to_double(direction));
    for (const Vec3 same : {direction, -direction, direction * 1e-30f, direction * 1e30f, to_float(unit)})
      EXPECT_TRUE(area.is_direction_affine({{}, same}));
    const Vec3d turned = unit + cross(unit, random_vector(random)) * 1e-2;
    EXPECT_FALSE(area.is_direction_affine({{}, to_float(turned)})) << length(turned);
  }
}

TEST(Area, ToleranceIsOneMinusTheCosine) {
  const AreaGeometry area({"z", PlaneArea{}, 0.01f});
  const auto tilted = [](double cosine) { return Ray{{}, to_float({std::sqrt(1 - cosine * cosine), 0, cosine})}; };
  EXPECT_TRUE(area.is_direction_affine(tilted(0.99001)));
  EXPECT_FALSE(area.is_direction_affine(tilted(0.98999)));
  EXPECT_TRUE(area.is_direction_affine(tilted(-0.99001)));
  EXPECT_FALSE(area.is_direction_affine(tilted(0)));
}

TEST(Area, OddDirectionsAreAnsweredWithoutNan) {
  for (const bool plane : {true, false}) {
    Random random(7);
    const AreaGeometry area(random_area(random, plane));
    EXPECT_FALSE(area.is_direction_affine({{}, {}}));
    EXPECT_FALSE(area.is_direction_affine({{}, {NAN, 0, 0}}));
    EXPECT_FALSE(area.is_direction_affine({{}, {kInf, 0, 0}}));
  }
  PlaneArea tiny;
  tiny.direction = {0, 0, 1e-45f};
  PlaneArea huge;
  huge.direction = {0, 0, 3e38f};
  for (const PlaneArea& plane : {tiny, huge}) {
    const AreaGeometry area({"z", plane, 0});
    EXPECT_TRUE(area.is_direction_affine({{}, {0, 0, 1e-45f}}));
    EXPECT_TRUE(area.is_direction_affine({{}, {0, 0, -3e38f}}));
    EXPECT_FALSE(area.is_direction_affine({{}, {3e38f, 0, 3e38f}}));
  }
}

TEST(Area, PointAreaDirectionsRunThroughTheEye) {
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, false));
    const Vec3 eye = std::get<PointArea>(area.area().shape).eye, p = to_float(point_inside(area.region(), random));
    EXPECT_TRUE(area.serves({p, p - eye}));
    EXPECT_TRUE(area.serves({p, eye - p}));
    const Vec3d across = cross(to_double(p - eye), random_vector(random));
    EXPECT_FALSE(area.serves({p, to_float(across)}));
    EXPECT_TRUE(area.is_direction_affine({eye, to_float(across)}));
    EXPECT_FALSE(area.serves({eye, to_float(area.frame().forward)}));  // the eye is before the near plane
    EXPECT_EQ(area.ray_direction(to_double(eye)), area.frame().forward);
  }
}

TEST(Area, ServesNeedsAnOriginInsideAndAValidRay) {
  const AreaGeometry area({"z", PlaneArea{}});
  EXPECT_TRUE(area.serves({{0, 0, 0}, {0, 0, 1}}));  // on the near face
  EXPECT_TRUE(area.serves({{1, 1, 1}, {0, 0, 1}}));  // on a corner
  EXPECT_FALSE(area.serves({{0, 0, -0.01f}, {0, 0, 1}}));
  EXPECT_FALSE(area.serves({{0, 0, 0.5f}, {1, 0, 0}}));
  EXPECT_FALSE(area.serves({{0, 0, 0.5f}, {0, 0, 1}, -1}));  // starts behind its origin
  EXPECT_FALSE(area.serves({{0, 0, 0.5f}, {0, 0, 1}, NAN}));
  EXPECT_FALSE(area.serves({{0, 0, NAN}, {0, 0, 1}}));
}

Bounds random_scene(Random& random) {
  Bounds scene;
  const float size = test::random_size(random, -3, 4);
  for (int i = 0; i < 2; ++i) scene.extend(to_float(random_vector(random)) * size);
  if (random.below(3) == 0) scene.hi[static_cast<int>(random.below(3))] = scene.lo.x;
  Bounds sorted;
  sorted.extend(scene.lo);
  sorted.extend(scene.hi);
  return sorted;
}

TEST(Area, DirectionalLightCoversTheScene) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Bounds scene = random_scene(random);
    const Vec3 direction = seed % 5 == 0 ? Vec3{0, -1, 0} : to_float(random_vector(random));
    const AreaGeometry area(directional_light_area("sun", direction, scene));
    EXPECT_TRUE(encloses(area.region(), scene));
    const double whole = area.projected_area(scene, Culling::kNone);
    EXPECT_NEAR(area.projected_area(scene, Culling::kWindow), whole, 1e-10 * whole);
    EXPECT_NEAR(area.hit_probability(scene) * area.window_area(), whole, 1e-10 * whole);
    double reach_x = 0, reach_y = 0, lowest = 1e300;
    for (int i = 0; i < 8; ++i) {
      const Vec3d p = to_local(area.frame(), to_double(corner(scene, i)));
      reach_x = std::fmax(reach_x, std::fabs(p.x));
      reach_y = std::fmax(reach_y, std::fabs(p.y));
      lowest = std::fmin(lowest, p.z);
    }
    EXPECT_LE(reach_x, area.window_half().x);
    EXPECT_LE(reach_y, area.window_half().y);
    EXPECT_GE(lowest, 0);
    const double scale = static_cast<double>(length(scene.lo) + length(scene.hi));
    EXPECT_LE(area.window_half().x, 1.002 * reach_x + 1e-5 * scale);
  }
}

TEST(Area, DirectionalLightRefusesWhatItCannotMean) {
  const Bounds scene{{0, 0, 0}, {1, 1, 1}};
  EXPECT_THROW(directional_light_area("sun", {}, scene), Error);
  EXPECT_THROW(directional_light_area("sun", {NAN, 0, 0}, scene), Error);
  EXPECT_THROW(directional_light_area("sun", {0, -1, 0}, Bounds{}), Error);
  EXPECT_NO_THROW(directional_light_area("sun", {0, -1, 0}, {{}, {}}));  // a single point
}

TEST(Area, SixPointLightAreasCoverAllDirections) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Bounds scene = random_scene(random);
    const Vec3 position = to_float(random_vector(random));
    std::vector<AreaGeometry> areas;
    for (const InfluenceArea& area : point_light_areas("lamp", position, scene)) areas.emplace_back(area);
    ASSERT_EQ(areas.size(), 6u);
    EXPECT_EQ(areas[0].area().name, "lamp+x");
    EXPECT_EQ(areas[5].area().name, "lamp-z");
    const double far_z = static_cast<double>(std::get<PointArea>(areas[0].area().shape).far_z);
    for (int i = 0; i < 50; ++i) {
      const Vec3d direction = normalized(random_vector(random));
      const Vec3 p = to_float(to_double(position) + direction * (far_z * random.uniform(0.01, 0.999)));
      int serving = 0;
      for (const AreaGeometry& area : areas) serving += area.serves({p, to_float(direction)});
      EXPECT_GE(serving, 1);
      EXPECT_LE(serving, 3);
    }
    for (int i = 0; i < 8; ++i) {
      bool reached = length(to_double(corner(scene, i)) - to_double(position)) < 2e-3 * far_z;
      for (const AreaGeometry& area : areas) reached = reached || contains(area.region(), corner(scene, i));
      EXPECT_TRUE(reached) << i;
    }
  }
}

TEST(Area, CameraSeesItsTargetAndKeepsTheAspect) {
  const Bounds scene{{-1, -1, -1}, {1, 1, 1}};
  const AreaGeometry area(camera_area("camera", {0, 0, -5}, {0, 0, 0}, 60, 1.5f, scene));
  EXPECT_NEAR(area.window_half().y, std::sqrt(3.0) / 3, 1e-7);
  EXPECT_NEAR(area.window_half().x / area.window_half().y, 1.5, 1e-6);
  EXPECT_TRUE(area.serves({{0, 0, 0}, {0, 0, 1}}));
  EXPECT_TRUE(encloses(area.region(), scene));
  EXPECT_THROW(camera_area("camera", {1, 1, 1}, {1, 1, 1}, 60, 1, scene), Error);
  EXPECT_THROW(camera_area("camera", {1, 1, 1}, {0, 0, 0}, 180, 1, scene), Error);
  EXPECT_THROW(camera_area("camera", {1, 1, 1}, {0, 0, 0}, 60, 0, scene), Error);
  EXPECT_THROW(camera_area("camera", {1, 1, 1}, {0, 0, 0}, NAN, 1, scene), Error);
  EXPECT_THROW(camera_area("camera", {1, 1, 1}, {NAN, 0, 0}, 60, 1, scene), Error);
}

}  // namespace
}  // namespace raygrain
