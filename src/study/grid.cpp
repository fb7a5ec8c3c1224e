// Grids of trees as studies.
#include <algorithm>
#include <initializer_list>
#include <span>

#include <fmt/format.h>

#include "raygrain/analyze.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/refine.h"
#include "raygrain/study.h"

#include "base/timer.h"
#include "io/crc32.h"
#include "study/frame_row.h"
#include "study/names.h"
#include "study/scene_pool.h"
#include "study/sources.h"
#include "study/tree_row.h"

namespace raygrain {

namespace study {

SceneTrees make_scene_trees(TriangleMesh mesh, Bvh global) {
  SceneTrees trees{std::move(mesh), std::move(global), {}};
  trees.wide_global = WideBvh(trees.global, trees.mesh);
  return trees;
}

}  // namespace study

namespace {

using study::Cells;
using study::LazyScene;
using study::SceneTrees;

constexpr double kMostRows = 1e6;

/// One row to be, with its own copies of what it is about.
struct GridRow {
  std::shared_ptr<const StudyGrid> grid;
  const StudyScene* named = nullptr;  // in the grid
  std::shared_ptr<LazyScene> scene;
  StudyArea area;
  StudyRecipe recipe;
  StudyRays rays;
  uint64_t seed = 1;

  std::vector<std::string> run() const;

 private:
  std::vector<Ray> sample(const SceneTrees& trees) const;
  std::vector<Ray> cast() const;
  LocalTree build(const SceneTrees& trees, std::span<const Ray> samples, const RayMeasure& own) const;
};

LocalTree GridRow::build(const SceneTrees& trees, std::span<const Ray> samples, const RayMeasure& own) const {
  LocalTree local = grid->rules.local_tree ? grid->rules.local_tree(trees.mesh, area.area, recipe)
                                           : build_local_tree(trees.mesh, area.area, recipe.recipe, grid->registry, {},
                                                              samples, {0, {}, true});
  local.area = area.area;
  if (!recipe.reinsert) return local;
  Bvh tree = *local.tree;
  raygrain::reinsert(tree, own, {.threads = 1, .costs = grid->costs});
  local.tree = std::make_shared<const Bvh>(std::move(tree));
  return local;
}

/// None where the recipe has no use for them.
std::vector<Ray> GridRow::sample(const SceneTrees& trees) const {
  if (!needs_samples(recipe.recipe, grid->registry)) return {};
  const std::vector<Ray> samples = sample_rays(area.area, seed, sample_count(recipe.recipe, grid->registry));
  if (needs_hits(recipe.recipe, grid->registry))
    return samples_for(recipe.recipe, grid->registry, samples, trees.mesh, &trees.global);
  return recipe.visible ? end_at_hits(samples, trees.global, trees.mesh) : samples;
}

std::vector<Ray> GridRow::cast() const {
  if (grid->rules.rays) return grid->rules.rays(*named, area, recipe, rays, seed);
  return cast_rays(AreaRays{.area = area.area, .spread = rays.spread}, rays.count, seed);
}

std::vector<std::string> GridRow::run() const {
  static const std::vector<StudyColumn> columns = grid_columns();
  const SceneTrees& trees = scene->get();
  const AreaGeometry geometry(area.area);
  const std::vector<Ray> samples = sample(trees);
  const BuildOptions options = make_build_options(recipe.recipe, grid->registry, {&area.area, samples});
  const std::vector<Ray> rays_of_row = cast();
  Cells cells(columns);
  study::set_recipe_cells(cells, recipe.recipe, options);
  if (recipe.in_frame) {
    study::set_frame_cells(cells, trees, geometry, recipe.recipe, options, rays_of_row);
    return cells.take();
  }
  const Timer timer;
  const LocalTree local = build(trees, samples, options.strategy.measure);
  const double build_seconds = timer.seconds();  // of all of it: choosing members and reinsertion, too
  study::TreeTest test = study::exact_test(trees, local, geometry, rays_of_row, grid->costs);
  if (grid->rules.serves) test.serves = grid->rules.serves(area.area);
  if (grid->rules.accepts)
    test.accepts = [this](const Ray& ray, const Hit& hit) { return grid->rules.accepts(area.area, ray, hit); };
  study::set_tree_cells(cells, test, grid->rules.local_tree ? local.measure : options.strategy.measure);
  cells.set("build_seconds", build_seconds);
  return cells.take();
}

void require(bool good, const StudyGrid& grid, const char* what) {
  if (!good) throw Error(ErrorCode::kUsage, grid.name, std::string("has no ") + what, "A grid needs at least one");
}

/// A name that is there twice would be looked up as the first.
template <class Entry>
void check_names(const StudyGrid& grid, const std::vector<Entry>& entries) {
  for (size_t i = 0; i < entries.size(); ++i)
    if (study::is_known_name(std::span(entries).first(i), entries[i].name))
      throw Error(ErrorCode::kUsage, grid.name, "the registry has two rows named \"" + entries[i].name + '"',
                  "Give a heuristic of your own another name");
}

/// Rows of two scenes by one name could not be told apart.
void check_scene_names(const StudyGrid& grid) {
  for (size_t i = 0; i < grid.scenes.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (grid.scenes[i].name == grid.scenes[j].name)
        throw Error(ErrorCode::kUsage, grid.name, "two scenes are named \"" + grid.scenes[i].name + '"',
                    "Give one of them another name");
}

void check_grid(const StudyGrid& grid) {
  if (grid.scenes.empty() && !grid.missing.empty()) study::fail_without_rows(grid.name, grid.missing);
  check_scene_names(grid);
  check_names(grid, grid.registry.measures);
  check_names(grid, grid.registry.orientations);
  check_names(grid, grid.registry.builders);
  require(!grid.scenes.empty(), grid, "scenes");
  require(!grid.recipes.empty(), grid, "recipes");
  require(!grid.rays.empty(), grid, "ray sets");
  require(!grid.seeds.empty(), grid, "seeds");
  require(grid.repeats > 0, grid, "repeats");
  uint64_t areas = 0;
  for (const StudyScene& scene : grid.scenes) areas += scene.areas.size();
  double rows = static_cast<double>(areas) * grid.repeats;
  for (const size_t count : {grid.recipes.size(), grid.rays.size(), grid.seeds.size()})
    rows *= static_cast<double>(count);
  if (rows > kMostRows)
    throw Error(ErrorCode::kLimit, grid.name, fmt::format("has {:.3g} rows; {:.0f} are the most", rows, kMostRows),
                "Split it, or take fewer seeds or repeats");
  for (const StudyRays& rays : grid.rays)
    if (rays.count == 0) throw Error(ErrorCode::kUsage, grid.name + ": rays " + rays.name, "must be at least 1");
  for (const StudyScene& scene : grid.scenes)
    for (const StudyArea& area : scene.areas) validate(area.area, scene.name + ' ' + area.variant);
}

void put(std::string& text, std::initializer_list<double> numbers) {
  for (const double number : numbers) text += fmt::format(" {}", number);
}

void put(std::string& text, const Recipe& recipe) {
  const PaperParameters& p = recipe.parameters;
  text += ' ' + recipe_name(recipe);
  put(text, {p.max_leaf_cost, p.max_leaf_area, p.max_leaf_hit_probability, p.split_plane_quality_threshold,
             p.acceptable_ratio, p.excellent_ratio});
  for (const uint32_t count : {p.max_triangles_per_leaf, p.max_levels, p.bins, p.max_non_fallback_levels})
    text += ' ' + std::to_string(count);
}

void put(std::string& text, const InfluenceArea& area) {
  const auto vectors = [&](std::initializer_list<Vec3> all) {
    for (const Vec3 v : all) put(text, {v.x, v.y, v.z});
  };
  put(text, {area.tolerance});
  if (const auto* plane = std::get_if<PlaneArea>(&area.shape)) {
    vectors({plane->center, plane->direction, plane->up});
    put(text, {plane->half_width, plane->half_height, plane->depth});
  } else {
    const auto& point = std::get<PointArea>(area.shape);
    vectors({point.eye, point.forward, point.up});
    put(text, {point.fov_x, point.fov_y, point.near_z, point.far_z});
  }
}

/// What decides the numbers and stands in no key: as a checksum, but for what people may want to read.
std::string identity_of(const StudyGrid& grid) {
  std::string text = grid.source;
  for (const StudyRecipe& recipe : grid.recipes) {
    put(text, recipe.recipe);
    for (const bool flag : {recipe.reinsert, recipe.in_frame, recipe.visible}) text += flag ? " yes" : " no";
  }
  text += study::contents_of(grid.scenes);
  for (const StudyScene& scene : grid.scenes)
    for (const StudyArea& area : scene.areas) put(text, area.area);
  put(text, {grid.costs.inner, grid.costs.triangle});
  std::string identity = "global " + recipe_name(grid.global);
  for (const StudyRays& rays : grid.rays) {
    identity += ", " + rays.name + ' ' + std::to_string(rays.count);
    put(text, {static_cast<double>(rays.spread)});
  }
  return identity + ", grid " + std::to_string(crc32(text));
}

/// Area and heuristics must fit each other before anything runs.
void check_recipe(const StudyGrid& grid, const StudyArea& area, const StudyRecipe& recipe) {
  const std::vector<Ray> one(1);
  try {
    validate(make_build_options(recipe.recipe, grid.registry, {&area.area, one}));
  } catch (const Error& error) {
    const std::string name = recipe.combo + (recipe.setting.empty() ? "" : ", " + recipe.setting);
    throw Error(error.code, grid.name + ": " + name, error.where + ": " + error.message, error.hint);
  }
}

void check_global(const StudyGrid& grid) {
  if (grid.rules.global_tree) return;
  try {
    validate(make_build_options(grid.global, grid.registry, {}));
  } catch (const Error& error) {
    throw Error(error.code, grid.name + ": global", error.where + ": " + error.message, error.hint);
  }
}

}  // namespace

Study make_study(const StudyGrid& given) {
  check_grid(given);
  check_global(given);
  const auto grid = std::make_shared<const StudyGrid>(given);
  Study study{grid->name, grid_columns(), {}, identity_of(*grid), grid->missing};
  for (const StudyScene& scene : grid->scenes) {
    const auto lazy = std::make_shared<LazyScene>([grid, load = scene.load] {
      TriangleMesh mesh = load();
      Bvh global = grid->rules.global_tree ? grid->rules.global_tree(mesh)
                                           : build_global_tree(mesh, grid->global, grid->registry);
      return study::make_scene_trees(std::move(mesh), std::move(global));
    });
    for (const StudyArea& area : scene.areas) {
      const char* kind = std::holds_alternative<PlaneArea>(area.area.shape) ? "plane" : "point";
      for (const StudyRecipe& recipe : grid->recipes) {
        bool checked = false;
        for (const StudyRays& rays : grid->rays) {
          if (grid->leave_out && grid->leave_out(scene, area, recipe, rays)) continue;
          StudyArea own = area;
          if (grid->rules.area) own.area = grid->rules.area(scene, area, recipe);
          if (!checked) check_recipe(*grid, own, recipe);
          checked = true;
          for (const uint64_t seed : grid->seeds)
            for (uint64_t repeat = 1; repeat <= grid->repeats; ++repeat) {
              const GridRow row{grid, &scene, lazy, own, recipe, rays, seed};
              study.add(
                  {scene.name, kind, area.variant, recipe.combo, recipe.setting, rays.name, seed, repeat},
                  [row] { return row.run(); }, scene.weight);
            }
        }
      }
    }
  }
  return study;
}

}  // namespace raygrain
