#include "area_structures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "accel/build_trees.h"
#include "base/parallel.h"
#include "stopwatch.h"

namespace raygrain::bench {
namespace {

/// All trees are built with planes that cut triangles: the best that each kind of tree can do.
Recipe best(const char* measure) {
  Recipe recipe{measure, "ALL", "", {}};
  set_quality(recipe, Quality::kBest);
  return recipe;
}

Bvh build_global(const TriangleMesh& mesh, unsigned threads) {
  return build_global_tree(mesh, best("SAH"), default_registry(), nullptr, {}, {threads, {}});
}

template <class Build>
void build_timed(BuildCost& cost, unsigned threads, const Build& build) {
  const Stopwatch watch(threads);
  build();
  cost.seconds = std::min(cost.seconds, watch.seconds());
}

/// What the trees are for: rays that share a direction or a point run exactly along their area.
std::vector<InfluenceArea> areas_of(const StructuredRays& rays) {
  std::vector<InfluenceArea> areas = rays.areas;
  if (rays.sharing != Sharing::kNothing)
    for (InfluenceArea& area : areas) area.tolerance = 0;
  return areas;
}

/// any(ray) and nearest(ray) answer one ray.
template <class Any, class Nearest>
std::function<void(Answers&)> one_by_one(const StructuredRays& rays, unsigned threads, Any any, Nearest nearest) {
  return [&rays, threads, any, nearest](Answers& answers) {
    parallel_for(rays.set.rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        if (rays.set.any)
          answers.flags[i] = any(rays.set.rays[i]) ? 1 : 0;
        else
          answers.hits[i] = nearest(rays.set.rays[i]);
      }
    });
  };
}

/// The frustum of a lamp that a ray to it is in: they come as +x, -x, +y, ...
size_t frustum_of(const Ray& ray) {
  const Vec3 d = ray.direction;
  const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  const int axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  return static_cast<size_t>(2 * axis + (d[axis] > 0 ? 1 : 0));
}

/// What coverages leave, through the global tree's arrays.
void trace_rest(const WideBvh& global, const StructuredRays& rays, std::span<const uint32_t> rest, unsigned threads,
                Answers& answers) {
  BenchRays left{"", rays.set.any, {}};
  for (const uint32_t i : rest) left.rays.push_back(rays.set.rays[i]);
  Answers found(rest.size());
  if (rays.set.any)
    global.occluded(left.rays, found.flags, threads);
  else
    global.intersect(left.rays, found.hits, threads);
  for (size_t i = 0; i < rest.size(); ++i) {
    if (rays.set.any)
      answers.flags[rest[i]] = found.flags[i];
    else
      answers.hits[rest[i]] = found.hits[i];
  }
}

/// As the accelerator asks its coverages.
void trace_batch(std::span<const Coverage> coverages, const WideBvh& global, const StructuredRays& rays,
                 unsigned threads, Answers& answers) {
  std::vector<uint32_t> rest;
  if (rays.sharing == Sharing::kDirection && rays.set.any) {
    coverages[0].occluded(rays.points, rays.common, answers.flags, rest, {}, threads);
  } else if (rays.sharing == Sharing::kDirection) {
    coverages[0].intersect(rays.points, rays.common, answers.hits, rest, {}, threads);
  } else if (rays.sharing == Sharing::kStart) {
    coverages[0].intersect_from(rays.common, rays.points, answers.hits, rest, {}, threads);
  } else {
    std::vector<const Coverage*> all;
    for (const Coverage& coverage : coverages) all.push_back(&coverage);
    const auto lists = Coverage::divide(all, rays.points, false, rest, threads);
    for (size_t i = 0; i < lists.size(); ++i)
      if (!lists[i].empty())
        coverages[i].occluded_towards(rays.points, rays.common, answers.flags, rest, lists[i], threads);
  }
  trace_rest(global, rays, rest, threads, answers);
}

}  // namespace

SceneStructures::SceneStructures(const TriangleMesh& given, unsigned threads)
    : mesh(std::make_shared<const TriangleMesh>(given)), threads_(threads) {
  build_again();
  accelerator.emplace(mesh, std::vector<LocalTree>{}, std::make_shared<const Bvh>(build_global(*mesh, threads_)));
}

void SceneStructures::build_again() {
  build_timed(cost, threads_, [&] { global = WideBvh(build_global(*mesh, threads_), *mesh, {.threads = threads_}); });
  cost.bytes = global.memory_bytes();
}

AreaStructures::AreaStructures(const SceneStructures& scene, const StructuredRays& rays, unsigned threads)
    : scene_(scene), areas_(areas_of(rays)), threads_(threads) {
  if (rays.sharing == Sharing::kNothing) return;
  // A tile is one cell where it is not asked for more: a flat grid.
  constexpr float kNoMore = 1e-6f;
  for (const auto& [name, cells, tile] :
       {std::tuple{"coverage", 0.25f, 256u}, std::tuple{"two levels, 1", 1.0f, 256u},
        std::tuple{"flat grid, 0.25", kNoMore, 4u}, std::tuple{"flat grid, 1", kNoMore, 1u}}) {
    CoverageOptions options;
    options.cells_per_triangle = cells;
    options.triangles_per_tile = tile;
    options.threads = threads;
    grids_.push_back({name, options, {}, {}});
  }
}

void AreaStructures::build() {
  for (GridOfCells& grid : grids_) build_coverage(grid);
  build_wide();
  build_frames();
  if (with_wide_) return;
  std::vector<LocalTree> locals = trees_.locals;
  with_wide_.emplace(scene_.accelerator->with_local_trees(locals));
  for (size_t i = 0; i < locals.size(); ++i) locals[i].in_ray_space = trees_.frames[i];
  with_frames_.emplace(scene_.accelerator->with_local_trees(std::move(locals)));
}

void AreaStructures::build_coverage(GridOfCells& grid) const {
  build_timed(grid.cost, threads_, [&] { grid.coverages = Coverage::of_areas(scene_.mesh, areas_, grid.options); });
  grid.cost.bytes = 0;
  for (const Coverage& coverage : grid.coverages) grid.cost.bytes += coverage.memory_bytes();
}

void AreaStructures::build_wide() {
  build_timed(trees_.cost_of_wide, threads_, [&] {
    trees_.locals.clear(), trees_.wide.clear();
    for (const InfluenceArea& area : areas_) {
      trees_.locals.push_back(
          build_local_tree(*scene_.mesh, area, best("PAH"), default_registry(), {}, {}, {threads_, {}}));
      const LocalTree& local = trees_.locals.back();
      trees_.wide.emplace_back(*local.tree, *scene_.mesh, WideOptions{.measure = local.measure, .threads = threads_});
    }
  });
  trees_.cost_of_wide.bytes = 0;
  for (const WideBvh& tree : trees_.wide) trees_.cost_of_wide.bytes += tree.memory_bytes();
}

void AreaStructures::build_frames() {
  AcceleratorOptions options;
  options.threads = threads_;
  size_t bytes = 0;
  build_timed(trees_.cost_of_frames, threads_, [&] {
    trees_.frames.clear();
    const auto corners = std::make_shared<const TriangleCorners>(*scene_.mesh);
    bytes = corners->memory_bytes();
    for (const InfluenceArea& area : areas_) {
      const std::vector<uint32_t> triangles = area_members(*scene_.mesh, AreaGeometry(area));
      trees_.frames.push_back(build_area_frame_tree(area, corners, triangles, {}, options));
    }
  });
  for (const std::optional<FrameTree>& tree : trees_.frames) bytes += tree ? tree->memory_bytes() : 0;
  trees_.cost_of_frames.bytes = bytes;
}

std::vector<Structure> AreaStructures::structures(const StructuredRays& rays) const {
  const WideBvh& global = scene_.global;
  std::vector<Structure> all;
  all.push_back({"global tree", "single", scene_.cost,
                 one_by_one(
                     rays, threads_, [&global](const Ray& ray) { return global.occluded(ray); },
                     [&global](const Ray& ray) { return global.intersect(ray); })});
  all.push_back({"global tree", "array", scene_.cost, [&rays, &global, threads = threads_](Answers& answers) {
                   if (rays.set.any)
                     global.occluded(rays.set.rays, answers.flags, threads);
                   else
                     global.intersect(rays.set.rays, answers.hits, threads);
                 }});
  add_trees(rays, all);
  add_accelerators(rays, all);
  add_coverages(rays, all);
  return all;
}

void AreaStructures::add_trees(const StructuredRays& rays, std::vector<Structure>& all) const {
  const WideBvh& global = scene_.global;
  const bool is_lamp = areas_.size() > 1;
  const auto of = [is_lamp](const auto& trees, const Ray& ray) -> const auto& {
    return trees[is_lamp ? frustum_of(ray) : 0];
  };
  const std::vector<WideBvh>& wide = trees_.wide;
  const std::vector<std::optional<FrameTree>>& frames = trees_.frames;
  all.push_back({"tree in ray space", "single", trees_.cost_of_frames,
                 one_by_one(
                     rays, threads_,
                     [of, &frames, &global](const Ray& ray) {
                       const std::optional<FrameTree>& tree = of(frames, ray);
                       const std::optional<bool> found = tree ? tree->occluded(ray) : std::nullopt;
                       return found ? *found : global.occluded(ray);
                     },
                     [of, &frames, &global](const Ray& ray) {
                       const std::optional<FrameTree>& tree = of(frames, ray);
                       const std::optional<Hit> found = tree ? tree->intersect(ray) : std::nullopt;
                       return found ? *found : global.intersect(ray);
                     })});
  all.push_back({"tree in the world", "single", trees_.cost_of_wide,
                 one_by_one(
                     rays, threads_, [of, &wide](const Ray& ray) { return of(wide, ray).occluded(ray); },
                     [of, &wide](const Ray& ray) { return of(wide, ray).intersect(ray); })});
}

void AreaStructures::add_accelerators(const StructuredRays& rays, std::vector<Structure>& all) const {
  for (const bool is_frame : {true, false}) {
    const Accelerator& accelerator = is_frame ? *with_frames_ : *with_wide_;
    all.push_back({is_frame ? "ray space, accelerator" : "world, accelerator", "single",
                   is_frame ? trees_.cost_of_frames : trees_.cost_of_wide,
                   [&rays, &accelerator, threads = threads_](Answers& answers) {
                     trace_singly(accelerator, rays, answers, threads);
                   }});
  }
}

void AreaStructures::add_coverages(const StructuredRays& rays, std::vector<Structure>& all) const {
  const WideBvh& global = scene_.global;
  for (const GridOfCells& grid : grids_) {
    const std::span<const Coverage> coverages = grid.coverages;
    all.push_back({grid.name, "batch", grid.cost, [&rays, &global, coverages, threads = threads_](Answers& answers) {
                     trace_batch(coverages, global, rays, threads, answers);
                   }});
    all.push_back({grid.name, "single", grid.cost,
                   one_by_one(
                       rays, threads_,
                       [coverages, &global](const Ray& ray) {
                         for (const Coverage& coverage : coverages)
                           if (const std::optional<bool> found = coverage.occluded(ray)) return *found;
                         return global.occluded(ray);
                       },
                       [coverages, &global](const Ray& ray) {
                         for (const Coverage& coverage : coverages)
                           if (const std::optional<Hit> found = coverage.intersect(ray)) return *found;
                         return global.intersect(ray);
                       })});
  }
}

}  // namespace raygrain::bench
