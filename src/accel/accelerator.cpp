#include "raygrain/accelerator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "raygrain/error.h"

#include "accel/accelerator_parts.h"
#include "accel/build_trees.h"
#include "accel/route_costs.h"
#include "accel/search.h"
#include "base/timer.h"

namespace raygrain {

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
    table.axes.emplace_back(table.geometries.back());
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

void validate_mesh_and_global(const TriangleMesh* mesh, const Bvh* global) {
  if (mesh == nullptr) throw Error(ErrorCode::kUsage, "mesh", "is missing");
  validate(*mesh, "mesh");
  validate_tree(global, triangle_bounds(*mesh), {}, "global tree");
}

void validate_locals(const TriangleMesh& mesh, std::span<const LocalTree> locals) {
  const std::vector<Bounds> bounds = locals.empty() ? std::vector<Bounds>{} : triangle_bounds(mesh);
  for (size_t i = 0; i < locals.size(); ++i) {
    const std::string where = area_label(i, locals[i].area);
    validate(locals[i].area, where);
    const Bvh* tree = locals[i].tree.get();
    if (tree != nullptr && tree->nodes.empty() && tree->prims.empty()) continue;  // an area that touches nothing
    validate_tree(tree, bounds, tree != nullptr ? std::span<const uint32_t>(tree->prims) : std::span<const uint32_t>{},
                  where);
  }
}

std::vector<SearchTree> make_searches(const TriangleMesh& mesh, std::span<const LocalTree> locals,
                                      Traversal traversal) {
  std::vector<SearchTree> searches;
  searches.reserve(locals.size());
  for (const LocalTree& local : locals) {
    searches.push_back(make_search_tree(mesh, local.tree, local.measure, traversal));
    if (local.in_ray_space && traversal == Traversal::kWide) searches.back().add_ray_space(*local.in_ray_space);
  }
  return searches;
}

}  // namespace

Accelerator::Accelerator(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}

Accelerator::Accelerator(TriangleMesh mesh, std::vector<InfluenceArea> areas, const AcceleratorOptions& options) {
  validate(mesh, "mesh");
  for (size_t i = 0; i < areas.size(); ++i) validate(areas[i], area_label(i, areas[i]));
  auto shared = std::make_shared<const TriangleMesh>(std::move(mesh));
  BuiltTrees trees = build_trees(*shared, areas, options);
  const Timer timer;
  AreaTable table = make_area_table(trees.locals, options.top_level);
  const double table_seconds = timer.seconds();
  std::vector<AreaGeometry> geometries(areas.begin(), areas.end());
  std::vector<Coverage> coverages = build_coverages(shared, areas, options);
  auto parts = std::make_shared<Parts>(
      Parts{std::move(shared), std::move(trees.locals), std::move(trees.local_searches), std::move(*trees.global),
            std::move(table), options.traversal, std::move(geometries), std::move(coverages)});
  const bool by_cost = options.routing == Routing::kCheapest && options.traversal == Traversal::kWide;
  parts->choose_routes(by_cost, options.samples, options.isa.value_or(default_isa()));
  parts->shared_seconds += table_seconds;
  parts_ = std::move(parts);
}

Accelerator::Accelerator(std::shared_ptr<const TriangleMesh> mesh, std::vector<LocalTree> locals,
                         std::shared_ptr<const Bvh> global, const TopLevelOptions& top_level, Traversal traversal) {
  validate_mesh_and_global(mesh.get(), global.get());
  validate_locals(*mesh, locals);
  std::vector<SearchTree> searches = make_searches(*mesh, locals, traversal);
  SearchTree search = make_search_tree(*mesh, std::move(global), {}, traversal);
  AreaTable table = make_area_table(locals, top_level);
  auto parts = std::make_shared<Parts>(
      Parts{std::move(mesh), std::move(locals), std::move(searches), std::move(search), std::move(table), traversal});
  parts->choose_routes(false, {}, default_isa());
  parts_ = std::move(parts);
}

Accelerator Accelerator::with_local_trees(std::vector<LocalTree> locals, const TopLevelOptions& top_level) const {
  validate_locals(*parts_->mesh, locals);
  std::vector<SearchTree> searches = make_searches(*parts_->mesh, locals, parts_->traversal);
  AreaTable table = make_area_table(locals, top_level);
  auto parts = std::make_shared<Parts>(
      Parts{parts_->mesh, std::move(locals), std::move(searches), parts_->global, std::move(table), parts_->traversal});
  parts->choose_routes(false, {}, default_isa());
  return Accelerator(std::move(parts));
}

void Accelerator::Parts::choose_routes(bool by_cost, const SampleSource& samples, Isa isa) {
  const Timer timer;
  if (geometries.empty()) geometries = areas.geometries;
  const auto trace = [this](bool is_any, const Ray& ray, const Route& route, AcceleratorCounters& counters) {
    if (is_any)
      any(ray, route, &counters);
    else
      nearest(ray, route, &counters);
  };
  if (by_cost) costs = predict_costs({*mesh, geometries, coverages, !locals.empty(), trace}, samples);
  many_shares = shares_of_many(isa, global.wide_bytes());
  routes = raygrain::choose_routes(geometries, coverages, !locals.empty(), costs, many_shares);
  for (size_t i = 0; i < locals.size(); ++i) {
    const auto searched = [i](const Route& route) { return route.searches[i] != 0; };
    if (searched(routes.any) || searched(routes.nearest) || searched(routes.any_of_many) ||
        searched(routes.nearest_of_many))
      continue;
    searches[i].drop_fast_forms();
    locals[i].in_ray_space.reset();
  }
  shared_seconds = timer.seconds();
}

std::span<const Coverage> Accelerator::coverages() const {
  return parts_->coverages;
}

const TriangleMesh& Accelerator::mesh() const {
  return *parts_->mesh;
}

std::span<const LocalTree> Accelerator::local_trees() const {
  return parts_->locals;
}

const Bvh& Accelerator::global_tree() const {
  return *parts_->global.binary();
}

const TopLevel& Accelerator::top_level() const {
  return parts_->areas.top_level;
}

Traversal Accelerator::traversal() const {
  return parts_->traversal;
}

void AcceleratorCounters::add(const AcceleratorCounters& other) {
  rays += other.rays;
  invalid_rays += other.invalid_rays;
  covered += other.covered;
  areas_tested += other.areas_tested;
  areas_serving += other.areas_serving;
  local_searches += other.local_searches;
  local_hits += other.local_hits;
  continued += other.continued;
  columns += other.columns;
  cones += other.cones;
  global_searches += other.global_searches;
  local.add(other.local);
  global.add(other.global);
  areas.resize(std::max(areas.size(), other.areas.size()));
  for (size_t i = 0; i < other.areas.size(); ++i) {
    areas[i].covered += other.areas[i].covered;
    areas[i].local += other.areas[i].local;
    areas[i].global += other.areas[i].global;
  }
}

}  // namespace raygrain
