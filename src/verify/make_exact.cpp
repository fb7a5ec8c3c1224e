// The definition beside brute force: who watches the one intersector.
#include "raygrain/triangle.h"

#include "trace/nearest_of_all.h"
#include "verify/spec.h"

namespace raygrain::verification {
namespace {

constexpr size_t kMostTriangles = 600;      // it takes microseconds for each
constexpr size_t kStride = 128, kFew = 64;  // rays; all of a group of few

}  // namespace

AnswerRays make_exact(const StructureSpec& spec, const VerifyScene& scene) {
  if (scene.mesh->triangle_count() > kMostTriangles) return {};
  return [mesh = scene.mesh, seed = spec.seed](const RayGroup& group, const RayAnswers& answers) {
    const bool are_few = group.rays.size() <= kFew;
    for (size_t i = are_few ? 0 : seed % kStride; i < group.rays.size(); i += are_few ? 1 : kStride) {
      answers.nearest[i] = nearest_of_all(*mesh, group.rays[i], intersect_triangle_exact);
      answers.any[i] = is_hit(answers.nearest[i]);
      answers.told[i] = RayAnswers::kNearest | RayAnswers::kAny;
    }
  };
}

}  // namespace raygrain::verification
