#include "cube.h"

#include "files.h"
#include "io/mesh_polygons.h"

namespace raygrain::fuzz {

TriangleMesh cube() {
  return triangulated(parse_obj(kCubeObj, "cube.obj"), "cube.obj");
}

std::vector<Ray> rays_around(const TriangleMesh& mesh) {
  std::vector<Vec3> targets = triangle_centroids(mesh);
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 a = mesh.vertex(i, corner), b = mesh.vertex(i, (corner + 1) % 3);
      targets.push_back(a);
      targets.push_back((a + b) * 0.5f);
    }
  std::vector<Ray> rays;
  for (const Vec3 origin : {Vec3{-1, 0.5f, 0.25f}, Vec3{0.5f, 0.5f, 0.5f}, Vec3{3, -2, 0}})
    for (const Vec3 target : targets) rays.push_back({origin, target - origin});
  for (const Vec3 target : targets) rays.push_back({{target.x, target.y, -4}, {0, 0, 1}});
  return rays;
}

}  // namespace raygrain::fuzz
