// What an accelerator refuses, and what it says of it.
#include <string>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"

#include "accel/scenes.h"

namespace raygrain {
namespace {

using test::error_of;
using test::random_mesh;
using test::some_areas;
using test::z_area;

TEST(Accelerator, ErrorsNameTheAreaAndThePart) {
  const TriangleMesh mesh = random_mesh(20, 9);
  std::vector<InfluenceArea> areas = some_areas();
  std::get<PointArea>(areas[1].shape).near_z = 7;
  Error error = error_of([&] { Accelerator(mesh, areas); });
  EXPECT_EQ(error.code, ErrorCode::kBadArea);
  EXPECT_NE(std::string(error.what()).find("areas[1] 'lamp'"), std::string::npos) << error.what();

  TriangleMesh bad = mesh;
  bad.triangles[3][1] = 1000;
  EXPECT_EQ(error_of([&] { Accelerator(bad, some_areas()); }).code, ErrorCode::kBadMesh);

  AcceleratorOptions options;
  options.local.measure = "PHA";
  EXPECT_EQ(error_of([&] { Accelerator(mesh, some_areas(), options); }).code, ErrorCode::kUsage);
  options = {};
  options.top_level.max_level = 30;
  EXPECT_EQ(error_of([&] { Accelerator(mesh, some_areas(), options); }).code, ErrorCode::kUsage);
}

TEST(Accelerator, RefusesPartsThatDoNotFit) {
  const auto mesh = std::make_shared<const TriangleMesh>(random_mesh(20, 10));
  const Registry registry = default_registry();
  const auto global = std::make_shared<const Bvh>(build_global_tree(*mesh, {"SAH", "ALL", "binned", {}}, registry));
  const LocalTree local = build_local_tree(*mesh, z_area("sun", -2, 4), {"PAH", "ALL", "binned", {}}, registry);

  EXPECT_EQ(error_of([&] { Accelerator(nullptr, {local}, global); }).code, ErrorCode::kUsage);
  EXPECT_EQ(error_of([&] { Accelerator(mesh, {local}, nullptr); }).where, "global tree");
  LocalTree no_tree = local;
  no_tree.tree = nullptr;
  EXPECT_EQ(error_of([&] { Accelerator(mesh, {local, no_tree}, global); }).where, "areas[1] 'sun'");

  Bvh wrong = *local.tree;
  wrong.prims[0] = 20;  // no such triangle
  LocalTree bad = local;
  bad.tree = std::make_shared<const Bvh>(wrong);
  EXPECT_EQ(error_of([&] { Accelerator(mesh, {bad}, global); }).where, "areas[0] 'sun'");
  // A global tree must hold every triangle.
  EXPECT_EQ(error_of([&] { Accelerator(mesh, {local}, local.tree); }).where, "global tree");
}

}  // namespace
}  // namespace raygrain
