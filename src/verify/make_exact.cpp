// The definition beside brute force: who watches the one intersector.
#include "raygrain/triangle.h"

#include "verify/spec.h"

namespace raygrain::verification {
namespace {

constexpr size_t kMostTriangles = 600;      // it takes microseconds for each
constexpr size_t kStride = 128, kFew = 64;  // rays; all of a group of few

Hit nearest_exactly(const TriangleMesh& mesh, const Ray& ray) {
  Hit nearest;
  if (!is_valid(ray)) return nearest;
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    Hit hit;
    if (!intersect_triangle_exact(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) continue;
    hit.triangle = i;
    if (is_nearer(hit, nearest)) nearest = hit;
  }
  return nearest;
}

}  // namespace

AnswerRays make_exact(const StructureSpec& spec, const VerifyScene& scene) {
  if (scene.mesh->triangle_count() > kMostTriangles) return {};
  return [mesh = scene.mesh, seed = spec.seed](const RayGroup& group, const RayAnswers& answers) {
    const bool are_few = group.rays.size() <= kFew;
    for (size_t i = are_few ? 0 : seed % kStride; i < group.rays.size(); i += are_few ? 1 : kStride) {
      answers.nearest[i] = nearest_exactly(*mesh, group.rays[i]);
      answers.any[i] = is_hit(answers.nearest[i]);
      answers.told[i] = RayAnswers::kNearest | RayAnswers::kAny;
    }
  };
}

}  // namespace raygrain::verification
