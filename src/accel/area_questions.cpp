#include "accel/area_questions.h"

#include <variant>

#include "raygrain/rays.h"

namespace raygrain {
namespace {

Vec3 point_of(const AreaGeometry& area) {
  return std::get<PointArea>(area.area().shape).eye;
}

/// Of the whole scene's surfaces, as long as some are the area's.
std::vector<Ray> from_surfaces(const AreaGeometry& area, const TriangleMesh& mesh, size_t count, uint64_t seed) {
  constexpr uint64_t kRounds = 8;
  SurfaceRays surface{TowardsDirection{to_float(area.frame().forward)}};
  if (!area.is_plane()) surface.target = TowardsPoint{point_of(area)};
  std::vector<Ray> found;
  for (uint64_t round = 0; round < kRounds && found.size() < count; ++round)
    for (const Ray& ray : cast_rays(surface, mesh, count, seed * kRounds + round))
      if (found.size() < count && area.serves(ray)) found.push_back(ray);
  return found;
}

std::vector<Ray> from_where_rays_start(const AreaGeometry& area, size_t count, uint64_t seed) {
  std::vector<Ray> rays = cast_rays(AreaRays{area.area()}, count, seed);
  if (area.is_plane()) return rays;
  for (Ray& ray : rays) ray.origin = point_of(area);
  return rays;
}

}  // namespace

AreaQuestions questions_of(const AreaGeometry& area, const TriangleMesh& mesh, bool any, size_t count, uint64_t seed) {
  AreaQuestions questions;
  questions.any = any;
  questions.rays = any ? from_surfaces(area, mesh, count, seed) : from_where_rays_start(area, count, seed);
  if (!area.is_plane())
    questions.common = point_of(area);
  else if (!questions.rays.empty())
    questions.common = questions.rays[0].direction;
  for (const Ray& ray : questions.rays) questions.points.push_back(any || area.is_plane() ? ray.origin : ray.direction);
  return questions;
}

void ask_together(const Accelerator& scene, const AreaQuestions& questions, bool is_plane, AreaAnswers& answers,
                  AcceleratorCounters* counters) {
  const auto& [any, rays, common, points] = questions;
  if (is_plane && any) scene.occluded(points, common, answers.flags, 1, counters);
  if (is_plane && !any) scene.intersect(points, common, answers.hits, 1, counters);
  if (!is_plane && any) scene.occluded_towards(points, common, answers.flags, 1, counters);
  if (!is_plane && !any) scene.intersect_from(common, points, answers.hits, 1, counters);
}

void ask_one_by_one(const Accelerator& scene, const AreaQuestions& questions, AreaAnswers& answers,
                    AcceleratorCounters* counters) {
  for (size_t i = 0; i < questions.size(); ++i) {
    if (questions.any)
      answers.flags[i] = scene.occluded(questions.rays[i], counters) ? 1 : 0;
    else
      answers.hits[i] = scene.intersect(questions.rays[i], counters);
  }
}

}  // namespace raygrain
