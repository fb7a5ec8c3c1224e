#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "io/mesh_polygons.h"
#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

struct Known {
  const char* name;
  size_t triangles, without_area;
};

size_t count_without_area(const TriangleMesh& mesh) {
  size_t count = 0;
  for (size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Vec3d a = to_double(mesh.vertex(i, 0));
    count += cross(to_double(mesh.vertex(i, 1)) - a, to_double(mesh.vertex(i, 2)) - a) == Vec3d{};
  }
  return count;
}

class SharedMesh : public testing::TestWithParam<Known> {};

TEST_P(SharedMesh, HasAllItsTriangles) {
  const auto path = test::shared_scene(GetParam().name);
  if (!path) GTEST_SKIP() << "needs ../shared/scenes";
  LoadOptions options;
  options.isolation = Isolation::kChildProcess;
  LoadReport report;
  const TriangleMesh mesh = load_mesh(*path, options, &report);
  EXPECT_EQ(mesh.triangle_count(), GetParam().triangles);
  EXPECT_EQ(count_without_area(mesh), GetParam().without_area);
  EXPECT_EQ(report.dropped_lines + report.dropped_points, 0u);
}

TEST_P(SharedMesh, AssimpSeesTheSameTriangles) {
  const auto path = test::shared_scene(GetParam().name);
  if (!path || GetParam().triangles > 300000) GTEST_SKIP() << "needs ../shared/scenes, and a small file";
  const TriangleMesh ours = load_mesh(*path), theirs = triangulated(import_with_assimp(*path), *path);
  ASSERT_EQ(ours.triangle_count(), theirs.triangle_count());
  const std::vector<Vec3> a = test::corner_positions(ours), b = test::corner_positions(theirs);
  size_t different = 0;
  for (size_t i = 0; i < a.size(); ++i)
    different += length(to_double(a[i]) - to_double(b[i])) > 1e-6 * length(to_double(a[i])) + 1e-7;
  EXPECT_EQ(different, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SharedMesh,
                         testing::Values(Known{"suzanne.obj", 967, 0}, Known{"cottage.obj", 4281, 0},
                                         Known{"cottage_walls.obj", 5817, 0}, Known{"woods.obj", 7058, 76},
                                         Known{"city.ply", 41187, 0}, Known{"sponza.ply", 262267, 232},
                                         Known{"crowd.ply", 272171, 0}, Known{"crowd_large.ply", 1427903, 0}),
                         [](const auto& parameter) {
                           std::string name = parameter.param.name;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace raygrain
