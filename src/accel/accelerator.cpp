#include "raygrain/accelerator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "raygrain/error.h"
#include "raygrain/refine.h"

#include "accel/search.h"
#include "base/parallel.h"

namespace raygrain {

struct Accelerator::Parts {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<LocalTree> locals;
  std::shared_ptr<const Bvh> global;
  AreaTable areas;
};

namespace {

std::string area_label(size_t index, const InfluenceArea& area) {
  return "areas[" + std::to_string(index) + "]" + (area.name.empty() ? "" : " '" + area.name + "'");
}

/// Places of the areas in the order of predicted cost, ties by index; NaN counts as the highest cost.
std::vector<uint32_t> ranks_by_cost(std::span<const LocalTree> locals) {
  const auto cost = [&](uint32_t i) {
    return std::isnan(locals[i].predicted_cost) ? std::numeric_limits<double>::infinity() : locals[i].predicted_cost;
  };
  std::vector<uint32_t> order(locals.size()), ranks(locals.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, cost);
  for (uint32_t rank = 0; rank < order.size(); ++rank) ranks[order[rank]] = rank;
  return ranks;
}

AreaTable make_area_table(std::span<const LocalTree> locals, const TopLevelOptions& options) {
  AreaTable table;
  std::vector<ConvexRegion> regions;
  for (const LocalTree& local : locals) {
    table.geometries.emplace_back(local.area);
    regions.push_back(table.geometries.back().region());
  }
  table.ranks = ranks_by_cost(locals);
  table.top_level = TopLevel(regions, options);
  return table;
}

/// A traversal trusts its tree: what a caller hands in must be sound.
void validate_tree(const Bvh* tree, std::span<const Bounds> bounds, std::span<const uint32_t> expected,
                   const std::string& where) {
  if (tree == nullptr) throw Error(ErrorCode::kUsage, where, "has no tree");
  if (const auto defect = find_defect(*tree, bounds, expected)) throw Error(ErrorCode::kUsage, where, *defect);
}

void validate_parts(const TriangleMesh* mesh, std::span<const LocalTree> locals, const Bvh* global) {
  if (mesh == nullptr) throw Error(ErrorCode::kUsage, "mesh", "is missing");
  validate(*mesh, "mesh");
  const std::vector<Bounds> bounds = triangle_bounds(*mesh);
  validate_tree(global, bounds, {}, "global tree");
  for (size_t i = 0; i < locals.size(); ++i) {
    const std::string where = area_label(i, locals[i].area);
    validate(locals[i].area, where);
    const Bvh* tree = locals[i].tree.get();
    if (tree != nullptr && tree->nodes.empty() && tree->prims.empty()) continue;  // an area that touches nothing
    validate_tree(tree, bounds, tree != nullptr ? std::span<const uint32_t>(tree->prims) : std::span<const uint32_t>{},
                  where);
  }
}

struct Trees {
  std::vector<LocalTree> locals;
  std::shared_ptr<const Bvh> global;
};

Bvh build_global(const TriangleMesh& mesh, const AcceleratorOptions& options, std::span<const Ray> samples) {
  Recipe recipe = options.global;
  if (options.quality) recipe.builder = builder_name(*options.quality);
  Bvh tree = build_global_tree(mesh, recipe, options.registry, nullptr, samples);
  if (!options.reinsert) return tree;
  const BuildOptions build = make_build_options(recipe, options.registry, {nullptr, samples});
  ReinsertOptions reinsertion;
  reinsertion.threads = options.threads;
  reinsertion.costs = build.costs;
  raygrain::reinsert(tree, build.strategy.measure, reinsertion);
  return tree;
}

/// One task per tree, the global one first because it is the longest.
Trees build_trees(const TriangleMesh& mesh, std::span<const InfluenceArea> areas, const AcceleratorOptions& options) {
  const auto samples = [&](const InfluenceArea* area) {
    return options.samples ? options.samples(area) : std::vector<Ray>{};
  };
  Trees trees;
  trees.locals.resize(areas.size());
  const auto build = [&](size_t task) {
    if (task == 0) {
      trees.global = std::make_shared<const Bvh>(build_global(mesh, options, samples(nullptr)));
    } else {
      const InfluenceArea& area = areas[task - 1];
      trees.locals[task - 1] =
          build_local_tree(mesh, area, options.local, options.registry, options.membership, samples(&area));
    }
  };
  parallel_for(areas.size() + 1, 1, options.threads, [&](size_t begin, size_t end) {
    for (size_t task = begin; task < end; ++task) build(task);
  });
  return trees;
}

/// Are all hits of the ray that can be nearer than `best` known, when those with t <= exit are?
bool is_final(const Hit& best, const Ray& ray, float exit) {
  return std::min(best.t, ray.tmax) <= exit;
}

}  // namespace

Accelerator::Accelerator(TriangleMesh mesh, std::vector<InfluenceArea> areas, const AcceleratorOptions& options) {
  validate(mesh, "mesh");
  for (size_t i = 0; i < areas.size(); ++i) validate(areas[i], area_label(i, areas[i]));
  Trees trees = build_trees(mesh, areas, options);
  AreaTable table = make_area_table(trees.locals, options.top_level);
  parts_ = std::make_shared<const Parts>(Parts{std::make_shared<const TriangleMesh>(std::move(mesh)),
                                               std::move(trees.locals), std::move(trees.global), std::move(table)});
}

Accelerator::Accelerator(std::shared_ptr<const TriangleMesh> mesh, std::vector<LocalTree> locals,
                         std::shared_ptr<const Bvh> global, const TopLevelOptions& top_level) {
  validate_parts(mesh.get(), locals, global.get());
  AreaTable table = make_area_table(locals, top_level);
  parts_ =
      std::make_shared<const Parts>(Parts{std::move(mesh), std::move(locals), std::move(global), std::move(table)});
}

Hit Accelerator::intersect(const Ray& ray, AcceleratorCounters* counters) const {
  AcceleratorCounters unwanted;
  AcceleratorCounters& count = counters != nullptr ? *counters : unwanted;
  ++count.rays;
  if (!is_valid(ray)) {
    ++count.invalid_rays;
    return {};
  }
  Hit best;
  AreaWalk walk(parts_->areas, ray, count);
  while (const auto stage = walk.next()) {
    const Bvh& tree = *parts_->locals[stage->area].tree;
    best = raygrain::intersect(tree, *parts_->mesh, ray, best, walk.search_options(), &count.local);
    if (!is_final(best, ray, stage->exit)) continue;
    if (is_hit(best)) ++count.local_hits;
    return best;
  }
  ++count.global_searches;
  return raygrain::intersect(*parts_->global, *parts_->mesh, ray, best, walk.search_options(), &count.global);
}

bool Accelerator::occluded(const Ray& ray, AcceleratorCounters* counters) const {
  AcceleratorCounters unwanted;
  AcceleratorCounters& count = counters != nullptr ? *counters : unwanted;
  ++count.rays;
  if (!is_valid(ray)) {
    ++count.invalid_rays;
    return false;
  }
  AreaWalk walk(parts_->areas, ray, count);
  while (const auto stage = walk.next()) {
    const Bvh& tree = *parts_->locals[stage->area].tree;
    if (raygrain::occluded(tree, *parts_->mesh, ray, walk.search_options(), &count.local)) {
      ++count.local_hits;  // wherever it is: any hit answers
      return true;
    }
    if (is_final({}, ray, stage->exit)) return false;
  }
  ++count.global_searches;
  return raygrain::occluded(*parts_->global, *parts_->mesh, ray, walk.search_options(), &count.global);
}

const TriangleMesh& Accelerator::mesh() const {
  return *parts_->mesh;
}

std::span<const LocalTree> Accelerator::local_trees() const {
  return parts_->locals;
}

const Bvh& Accelerator::global_tree() const {
  return *parts_->global;
}

const TopLevel& Accelerator::top_level() const {
  return parts_->areas.top_level;
}

size_t Accelerator::memory_bytes() const {
  size_t bytes = raygrain::memory_bytes(*parts_->global) + parts_->areas.top_level.memory_bytes();
  bytes += parts_->areas.geometries.capacity() * sizeof(AreaGeometry);
  bytes += parts_->areas.ranks.capacity() * sizeof(uint32_t);
  for (const LocalTree& local : parts_->locals) bytes += sizeof(LocalTree) + raygrain::memory_bytes(*local.tree);
  return bytes;
}

void AcceleratorCounters::add(const AcceleratorCounters& other) {
  rays += other.rays;
  invalid_rays += other.invalid_rays;
  areas_tested += other.areas_tested;
  areas_serving += other.areas_serving;
  local_searches += other.local_searches;
  local_hits += other.local_hits;
  continued += other.continued;
  global_searches += other.global_searches;
  local.add(other.local);
  global.add(other.global);
}

}  // namespace raygrain
