#include "accel/build_trees.h"

#include <algorithm>

#include "raygrain/refine.h"

#include "accel/joint_progress.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "build/estimate.h"

namespace raygrain {

namespace {

constexpr double kBuilt = 0.8;  // share of a tree's progress at which its wide form is begun

struct Global {
  std::shared_ptr<const Bvh> tree;
  RayMeasure measure;
};

Global build_global(const TriangleMesh& mesh, const AcceleratorOptions& options, std::span<const Ray> given,
                    JointProgress& progress) {
  Recipe recipe = options.global;
  if (options.quality) set_quality(recipe, *options.quality);
  const std::vector<Ray> samples = samples_for(recipe, options.registry, given, mesh, nullptr, options.threads);
  const double built = options.reinsert ? kBuilt / 2 : kBuilt;
  Bvh tree = build_global_tree(mesh, recipe, options.registry, nullptr, samples,
                               {options.threads, progress.part(0, 0, built), true});
  const BuildOptions build = make_build_options(recipe, options.registry, {nullptr, samples});
  if (options.reinsert) {
    ReinsertOptions reinsertion;
    reinsertion.threads = options.threads;
    reinsertion.costs = build.costs;
    reinsertion.progress = progress.part(0, built, kBuilt);
    raygrain::reinsert(tree, build.strategy.measure, reinsertion);
  }
  return {std::make_shared<const Bvh>(std::move(tree)), build.strategy.measure};
}

/// Recipes for the areas' trees, and for what makes their wide forms.
struct LocalRecipes {
  Recipe tree, wide;

  explicit LocalRecipes(const AcceleratorOptions& options) : tree(options.local), wide(options.local) {
    if (options.wide_measure.empty()) return;
    wide.measure = options.wide_measure;
    wide.orientation = "ALL";
  }
  bool need_hits(const Registry& registry) const { return needs_hits(tree, registry) || needs_hits(wide, registry); }
};

LocalTree build_local(const TriangleMesh& mesh, const InfluenceArea& area, const LocalRecipes& recipes,
                      const AcceleratorOptions& options, std::span<const Ray> given, const Bvh* global,
                      const std::function<bool(double)>& progress) {
  const auto samples_of = [&](const Recipe& recipe) {
    return samples_for(recipe, options.registry, given, mesh, global, options.threads);
  };
  LocalTree local = build_local_tree(mesh, area, recipes.tree, options.registry, options.membership,
                                     samples_of(recipes.tree), {options.threads, progress, true});
  if (options.reinsert_local) {
    Bvh tree = *local.tree;
    raygrain::reinsert(tree, local.measure, {.threads = options.threads});
    local.predicted_cost = estimated_cost(tree, local.measure, {});
    local.log.nodes.assign(tree.nodes.size(), {});  // says nothing about nodes that were moved
    local.tree = std::make_shared<const Bvh>(std::move(tree));
  }
  if (!options.wide_measure.empty())
    local.measure =
        make_build_options(recipes.wide, options.registry, {&area, samples_of(recipes.wide)}).strategy.measure;
  return local;
}

}  // namespace

SearchTree make_search_tree(const TriangleMesh& mesh, std::shared_ptr<const Bvh> binary, const RayMeasure& measure,
                            Traversal traversal, std::optional<Isa> isa, unsigned threads) {
  if (traversal == Traversal::kBinary) return {mesh, std::move(binary)};
  WideBvh wide(*binary, mesh, {.measure = measure, .isa = isa, .threads = threads});
  return {mesh, std::move(binary), std::move(wide)};
}

std::vector<Coverage> build_coverages(const std::shared_ptr<const TriangleMesh>& mesh,
                                      std::span<const InfluenceArea> areas, const AcceleratorOptions& options) {
  if (!options.coverage || options.traversal == Traversal::kBinary) return {};
  CoverageOptions coverage = *options.coverage;
  coverage.threads = options.threads;
  if (!coverage.isa) coverage.isa = options.isa;
  return Coverage::of_areas(mesh, areas, coverage);
}

namespace {

/// What builds of all areas share. `global` ends their samples where that is asked; `corners` where trees in ray space
/// are wanted.
struct AreaBuilds {
  const TriangleMesh& mesh;
  const AcceleratorOptions& options;
  LocalRecipes recipes;
  const Bvh* global = nullptr;
  std::shared_ptr<const TriangleCorners> corners;

  SearchTree build(const InfluenceArea& area, const std::function<bool(double)>& progress, LocalTree& local) const {
    const Timer timer;
    const std::vector<Ray> samples = options.samples ? options.samples(&area) : std::vector<Ray>{};
    local = build_local(mesh, area, recipes, options, samples, global, progress);
    SearchTree search =
        make_search_tree(mesh, local.tree, local.measure, options.traversal, options.isa, options.threads);
    if (corners != nullptr) {
      std::vector<uint32_t> triangles = local.tree->prims;
      std::ranges::sort(triangles);
      triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
      local.in_ray_space = build_area_frame_tree(area, corners, triangles, samples, options);
      if (local.in_ray_space) search.add_ray_space(*local.in_ray_space);
    }
    local.build_seconds = timer.seconds();
    return search;
  }
};

}  // namespace

LocalSpace local_space(const AcceleratorOptions& options) {
  if (options.space) return *options.space;
  const std::string usual = recipe_name(AcceleratorOptions{}.local);
  const bool answers = options.traversal == Traversal::kBinary || options.routing == Routing::kAreas;
  const bool is_chosen = recipe_name(options.local) != usual || options.reinsert_local ||
                         !options.wide_measure.empty() || options.membership;
  return answers || is_chosen || !options.coverage ? LocalSpace::kWorld : LocalSpace::kNone;
}

/// One task per tree, the global one first because it is the longest; and because it ends the samples of local trees
/// that ask where rays hit.
BuiltTrees build_trees(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                       const AcceleratorOptions& options) {
  const LocalSpace space = local_space(options);
  const size_t locals = space == LocalSpace::kNone ? 0 : areas.size();
  JointProgress progress(options.progress, locals + 1);
  BuiltTrees trees;
  trees.locals.resize(locals);
  std::vector<std::optional<SearchTree>> searches(locals);
  AreaBuilds own{mesh, options, LocalRecipes(options), nullptr, nullptr};
  const bool ends_samples = locals > 0 && own.recipes.need_hits(options.registry);
  const Timer timer;
  if (space == LocalSpace::kRay && options.traversal == Traversal::kWide)
    own.corners = std::make_shared<const TriangleCorners>(mesh);
  const double corners_seconds = timer.seconds();
  const auto build = [&](size_t task) {
    if (task > 0) {
      searches[task - 1] = own.build(areas[task - 1], progress.part(task, 0, kBuilt), trees.locals[task - 1]);
    } else {
      const std::vector<Ray> samples = options.samples ? options.samples(nullptr) : std::vector<Ray>{};
      Global global = build_global(mesh, options, samples, progress);
      trees.global = make_search_tree(mesh, std::move(global.tree), global.measure, options.traversal, options.isa,
                                      options.threads);
    }
    progress.reach(task, 1);
  };
  const size_t first = ends_samples ? 1 : 0;
  if (ends_samples) {
    build(0);
    own.global = trees.global->binary().get();
  }
  parallel_for(locals + 1 - first, 1, options.threads, [&](size_t begin, size_t end) {
    for (size_t task = begin; task < end; ++task) build(first + task);
  });
  for (LocalTree& local : trees.locals) local.build_seconds += corners_seconds / static_cast<double>(locals);
  for (std::optional<SearchTree>& search : searches) trees.local_searches.push_back(std::move(*search));
  return trees;
}

}  // namespace raygrain
