// The key property of the projected area measure: for its own rays it predicts what they really pay.
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/analyze.h"
#include "raygrain/heuristics.h"
#include "raygrain/rays.h"

#include "analyze/small_scenes.h"
#include "support/isotropic_rays.h"

namespace raygrain {
namespace {

constexpr size_t kRays = 20000;

struct Case {
  std::string name;
  InfluenceArea area;
};

std::vector<Case> areas() {
  std::vector<Case> cases;
  for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 1}, Vec3{-1, 0.26f, 0},
                               Vec3{0.3f, -0.8f, 0.5f}, Vec3{-0.45f, 0.3f, -1}, Vec3{1, 1, 1}}) {
    for (const float size : {4.0f, 14.0f}) {  // the window cuts through the scene; it holds the scene
      const std::string name = std::to_string(cases.size());
      cases.push_back({"sun " + name, test::sun_over(direction, size, 0.8f * size)});
      cases.push_back({"lamp " + name, test::lamp_over(direction, 6 * size, 5 * size)});
    }
  }
  for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{-0.45f, 0.3f, -1}, Vec3{1, 1, 1}}) {  // from amid the scene
    const std::string name = std::to_string(cases.size());
    cases.push_back({"lamp amid " + name, {"lamp", PointArea{{1, 0, -1}, direction, {0, 1, 0}, 80, 60, 0.5f, 30}}});
  }
  return cases;
}

/// How far the mean real cost of matched rays is from the estimate, in standard errors.
double z_score(const Bvh& bvh, const TriangleMesh& mesh, std::span<const Ray> rays, const RayMeasure& measure) {
  const TraceStats trace = analyze_rays(bvh, mesh, rays);
  const double error = trace.real_cost_deviation / std::sqrt(static_cast<double>(kRays));
  return (trace.real_cost - analyze(bvh, measure).estimated_cost) / error;
}

double z_score(const Bvh& bvh, const TriangleMesh& mesh, const InfluenceArea& area, const RayMeasure& measure,
               uint64_t seed) {
  return z_score(bvh, mesh, cast_rays(AreaRays{.area = area}, kRays, seed), measure);
}

TEST(Prediction, ProjectedAreaIsWhatMatchedRaysPay) {
  double squares = 0, largest = 0;
  const std::vector<Case> cases = areas();
  for (size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(cases[i].name);
    const InfluenceArea& area = cases[i].area;
    const TriangleMesh mesh = test::random_triangles({{-6, -6, -6}, {6, 6, 6}}, 300, 1.0, i + 1);
    const Recipe recipe = i % 2 ? Recipe{"PAH", "ALL", "binned", {}} : Recipe{"PAH", "SPFH", "paper", {}};
    const LocalTree local = build_local_tree(mesh, area, recipe, default_registry());
    const double z = z_score(*local.tree, mesh, area, projected_area_measure(area), 1000 + i);
    EXPECT_LT(std::abs(z), 4);
    largest = std::max(largest, std::abs(z));
    squares += z * z;
  }
  const double mean_square = squares / static_cast<double>(cases.size());
  RecordProperty("largest_z", std::to_string(largest));
  RecordProperty("mean_z_square", std::to_string(mean_square));
  EXPECT_GT(mean_square, 0.4);  // 35 squares of standard normals have mean 1 +- 0.24
  EXPECT_LT(mean_square, 1.8);
}

// Amid the scene, and outside where it fills the window's middle alone. There PAH is far off in its estimate.
TEST(Prediction, SolidAngleIsWhatIsotropicRaysPay) {
  for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{1, 1, 1}})
    for (const InfluenceArea& area :
         {InfluenceArea{"amid", PointArea{{1, 0, -1}, direction, {0, 1, 0}, 90, 90, 0.5f, 30}},
          InfluenceArea{"outside", PointArea{direction * -12.0f, direction, {0, 1, 0}, 90, 90, 0.5f, 60}}}) {
      SCOPED_TRACE(area.name);
      const TriangleMesh mesh = test::random_triangles({{-6, -6, -6}, {6, 6, 6}}, 300, 1.0, 9);
      const LocalTree local = build_local_tree(mesh, area, {"SOLID", "ALL", "binned", {}}, default_registry());
      const std::vector<Ray> rays = test::isotropic_rays(area, kRays, 11);
      EXPECT_LT(std::abs(z_score(*local.tree, mesh, rays, solid_angle_measure(area))), 4);
      EXPECT_GT(std::abs(z_score(*local.tree, mesh, rays, projected_area_measure(area))), 6);
    }
}

/// A plane area amid the scene: its measure projects whole boxes, so parts behind the start count as well and the
/// estimate is an upper bound; the hit probability of the part ahead is what rays pay.
TEST(Prediction, FromAmidTheScene) {
  for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{-0.45f, 0.3f, -1}, Vec3{1, 1, 1}}) {
    const InfluenceArea area{"sun", PlaneArea{{1, 0, -1}, direction, {0, 1, 0}, 4, 3, 1000}};
    const TriangleMesh mesh = test::random_triangles({{-6, -6, -6}, {6, 6, 6}}, 300, 1.0, 7);
    const LocalTree local = build_local_tree(mesh, area, {"PAH", "ALL", "binned", {}}, default_registry());
    const RayMeasure ahead([geometry = AreaGeometry(area)](
                               const Bounds& box) { return static_cast<float>(geometry.hit_probability(box)); },
                           1.0f);
    EXPECT_LT(std::abs(z_score(*local.tree, mesh, area, ahead, 5)), 4);
    EXPECT_LT(z_score(*local.tree, mesh, area, projected_area_measure(area), 5), 4);
  }
}

TEST(Prediction, AnyTreeIsPricedNotOnlyOwnOnes) {
  const InfluenceArea area = test::sun_over({0.3f, -0.8f, 0.5f}, 4, 3);
  const TriangleMesh mesh = test::random_triangles({{-6, -6, -6}, {6, 6, 6}}, 300, 1.0, 77);
  for (const char* measure : {"SAH", "PAH", "DIR"}) {
    SCOPED_TRACE(measure);
    const LocalTree local = build_local_tree(mesh, area, {measure, "LSPH", "paper", {}}, default_registry());
    EXPECT_LT(std::abs(z_score(*local.tree, mesh, area, projected_area_measure(area), 5)), 4);
  }
}

TEST(Prediction, SurfaceAreaIsNot) {
  const InfluenceArea area = test::sun_over({1, 0, 0}, 14, 14);
  const TriangleMesh mesh = test::random_triangles({{-6, -6, -6}, {6, 6, 6}}, 300, 1.0, 78);
  const LocalTree local = build_local_tree(mesh, area, {"PAH", "ALL", "binned", {}}, default_registry());
  EXPECT_GT(std::abs(z_score(*local.tree, mesh, area, surface_area_measure(), 5)), 20);
}

}  // namespace
}  // namespace raygrain
