// Coverages under verification: batches, and single rays.
#include <algorithm>

#include "raygrain/coverage.h"

#include "verify/ask.h"

namespace raygrain::verification {
namespace {

/// Marks all but the rest as told.
void tell_all_but(std::span<const uint32_t> rest, const RayAnswers& answers, uint8_t what) {
  std::vector<uint8_t> waits(answers.told.size(), 0);
  for (const uint32_t i : rest) waits[i] = 1;
  for (size_t i = 0; i < waits.size(); ++i)
    if (!waits[i]) answers.told[i] |= what;
}

std::vector<Vec3> origins_of(std::span<const Ray> rays) {
  std::vector<Vec3> origins;
  for (const Ray& ray : rays) origins.push_back(ray.origin);
  return origins;
}

void answer_one_by_one(const Coverage& coverage, const RayGroup& group, const RayAnswers& answers) {
  for (size_t i = 0; i < group.rays.size(); ++i) {
    if (const auto hit = coverage.intersect(group.rays[i])) {
      answers.nearest[i] = *hit;
      answers.told[i] |= RayAnswers::kNearest;
    }
    if (const auto any = coverage.occluded(group.rays[i])) {
      answers.any[i] = *any;
      answers.told[i] |= RayAnswers::kAny;
    }
  }
}

void answer_batch(const Coverage& coverage, const RayGroup& group, const RayAnswers& answers, unsigned threads) {
  std::vector<uint32_t> rest;
  const std::vector<Vec3> origins = origins_of(group.rays);
  if (group.kind == RayGroupKind::kDirection && coverage.sense(group.shared) == 1) {
    coverage.occluded(origins, group.shared, answers.any, rest, {}, threads);
    tell_all_but(rest, answers, RayAnswers::kAny | RayAnswers::kBatch);
  } else if (group.kind == RayGroupKind::kDirection && coverage.sense(group.shared) == -1) {
    coverage.intersect(origins, group.shared, answers.nearest, rest, {}, threads);
    tell_all_but(rest, answers, RayAnswers::kNearest | RayAnswers::kBatch);
  } else if (group.kind == RayGroupKind::kTowards && coverage.has_eye(group.shared)) {
    coverage.occluded_towards(origins, group.shared, answers.any, rest, {}, threads);
    tell_all_but(rest, answers, RayAnswers::kAny | RayAnswers::kBatch);
  } else if (group.kind == RayGroupKind::kFrom && coverage.has_eye(group.shared)) {
    std::vector<Vec3> directions;
    for (const Ray& ray : group.rays) directions.push_back(ray.direction);
    coverage.intersect_from(group.shared, directions, answers.nearest, rest, {}, threads);
    tell_all_but(rest, answers, RayAnswers::kNearest | RayAnswers::kBatch);
  } else {
    answer_one_by_one(coverage, group, answers);
  }
}

}  // namespace

AnswerRays make_coverage(const StructureSpec& spec, const VerifyScene& scene) {
  const InfluenceArea* area = area_of(spec, scene);
  if (area == nullptr) return {};
  const Coverage coverage(scene.mesh, *area, {spec.cells, spec.tile, parse_isa(spec.isa), parse_order(spec.order), 1});
  if (!coverage.is_useful()) return {};
  return [spec, coverage](const RayGroup& group, const RayAnswers& answers) {
    if (spec.batch == 0) return answer_one_by_one(coverage, group, answers);
    answer_batch(coverage, group, answers, spec.threads);
  };
}

}  // namespace raygrain::verification
