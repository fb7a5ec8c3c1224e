// From a mesh and an area to the area's tree.
#include <algorithm>
#include <numeric>

#include "raygrain/accelerator.h"

#include "build/estimate.h"
#include "geometry/triangle_boxes.h"

namespace raygrain {

std::vector<uint32_t> area_members(const TriangleMesh& mesh, const AreaGeometry& geometry, const MembershipRule& rule) {
  std::vector<uint32_t> members;
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    const Vec3 a = mesh.vertex(i, 0), b = mesh.vertex(i, 1), c = mesh.vertex(i, 2);
    if (rule ? rule(geometry, a, b, c) : overlaps(geometry.region(), a, b, c)) members.push_back(i);
  }
  return members;
}

std::vector<Ray> samples_for(const Recipe& recipe, const Registry& registry, std::span<const Ray> samples,
                             const TriangleMesh& mesh, const Bvh* tree, unsigned threads) {
  const bool has_ends = std::ranges::any_of(samples, [](const Ray& ray) { return ray.tmax < kInf; });
  if (!needs_hits(recipe, registry) || samples.empty() || has_ends) return {samples.begin(), samples.end()};
  if (tree != nullptr) return end_at_hits(samples, *tree, mesh);
  Recipe quick;
  set_quality(quick, Quality::kFast);
  return end_at_hits(samples, build_global_tree(mesh, quick, default_registry(), nullptr, {}, {threads, {}}), mesh);
}

namespace {

std::vector<Ray> samples_of(const TriangleMesh& mesh, const Recipe& recipe, const Registry& registry,
                            std::span<const Ray> samples, const BuildRun& run) {
  if (run.samples_are_ended) return {samples.begin(), samples.end()};
  return samples_for(recipe, registry, samples, mesh, nullptr, run.threads);
}

}  // namespace

LocalTree build_local_tree(const TriangleMesh& mesh, const InfluenceArea& area, const Recipe& recipe,
                           const Registry& registry, const MembershipRule& membership, std::span<const Ray> samples,
                           const BuildRun& run) {
  const AreaGeometry geometry(area);
  const std::vector<uint32_t> members = area_members(mesh, geometry, membership);
  std::vector<Bounds> bounds;
  std::vector<Vec3> centroids;
  bounds.reserve(members.size());
  for (const uint32_t i : members) bounds.push_back(triangle_bounds(mesh, i));
  if (needs_centroids(recipe, registry)) {
    centroids.reserve(members.size());
    for (const uint32_t i : members) centroids.push_back(triangle_centroid(mesh, i));
  }

  const std::vector<Ray> own_samples = samples_of(mesh, recipe, registry, samples, run);
  const HeuristicInput input{&area, own_samples, [&](uint32_t primitive, const Bounds& box) {
                               return clip_triangle_bounds(mesh, members[primitive], box);
                             }};
  LocalTree local;
  local.area = area;
  Bvh tree = build_tree(recipe, registry, input, bounds, centroids, &local.log, run);
  for (uint32_t& primitive : tree.prims) primitive = members[primitive];
  const BuildOptions options = make_build_options(recipe, registry, input);
  local.measure = options.strategy.measure;
  local.predicted_cost = estimated_cost(tree, local.measure, options.costs);
  local.tree = std::make_shared<const Bvh>(std::move(tree));
  return local;
}

Bvh build_global_tree(const TriangleMesh& mesh, const Recipe& recipe, const Registry& registry, BuildLog* log,
                      std::span<const Ray> samples, const BuildRun& run) {
  const std::vector<Ray> own_samples = samples_of(mesh, recipe, registry, samples, run);
  const HeuristicInput input{nullptr, own_samples, [&mesh](uint32_t triangle, const Bounds& box) {
                               return clip_triangle_bounds(mesh, triangle, box);
                             }};
  const std::vector<Vec3> centroids =
      needs_centroids(recipe, registry) ? triangle_centroids(mesh) : std::vector<Vec3>{};
  return build_tree(recipe, registry, input, triangle_boxes(mesh, run.threads), centroids, log, run);
}

}  // namespace raygrain
