// Grids of trees as studies.
#include <algorithm>
#include <initializer_list>
#include <set>

#include <fmt/format.h>

#include "raygrain/analyze.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/refine.h"
#include "raygrain/study.h"

#include "base/timer.h"
#include "io/crc32.h"
#include "study/frame_row.h"
#include "study/scene_pool.h"
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

/// One row to be, with its own copies of what it is about.
struct GridRow {
  std::shared_ptr<const StudyGrid> grid;
  std::shared_ptr<LazyScene> scene;
  StudyArea area;
  StudyRecipe recipe;
  StudyRays rays;
  uint64_t seed = 1;

  std::vector<std::string> run() const;

 private:
  std::vector<Ray> sample(const SceneTrees& trees) const;
  LocalTree build(const SceneTrees& trees, std::span<const Ray> samples, const RayMeasure& own) const;
};

LocalTree GridRow::build(const SceneTrees& trees, std::span<const Ray> samples, const RayMeasure& own) const {
  LocalTree local = build_local_tree(trees.mesh, area.area, recipe.recipe, grid->registry, {}, samples);
  if (!recipe.reinsert) return local;
  Bvh tree = *local.tree;
  raygrain::reinsert(tree, own, {.threads = 1, .costs = grid->costs});
  local.tree = std::make_shared<const Bvh>(std::move(tree));
  return local;
}

/// None where the recipe has no use for them.
std::vector<Ray> GridRow::sample(const SceneTrees& trees) const {
  if (!needs_samples(recipe.recipe, grid->registry)) return {};
  std::vector<Ray> samples = sample_rays(area.area, seed);
  if (!recipe.visible) return samples;
  for (Ray& ray : samples) ray.tmax = std::min(ray.tmax, intersect(trees.global, trees.mesh, ray).t);
  return samples;
}

std::vector<std::string> GridRow::run() const {
  static const std::vector<StudyColumn> columns = grid_columns();
  const SceneTrees& trees = scene->get();
  const AreaGeometry geometry(area.area);
  const std::vector<Ray> samples = sample(trees);
  const BuildOptions options = make_build_options(recipe.recipe, grid->registry, {&area.area, samples});
  const std::vector<Ray> cast = cast_rays(AreaRays{.area = area.area, .spread = rays.spread}, rays.count, seed);
  Cells cells(columns);
  study::set_recipe_cells(cells, recipe.recipe, options);
  if (recipe.in_frame) {
    study::set_frame_cells(cells, trees, geometry, recipe.recipe, options, cast);
    return cells.take();
  }
  const Timer timer;
  const LocalTree local = build(trees, samples, options.strategy.measure);
  const double build_seconds = timer.seconds();  // of all of it: choosing members and reinsertion, too
  study::set_tree_cells(cells, study::exact_test(trees, local, geometry, cast, grid->costs), options.strategy.measure);
  cells.set("build_seconds", build_seconds);
  return cells.take();
}

void require(bool good, const StudyGrid& grid, const char* what) {
  if (!good) throw Error(ErrorCode::kUsage, grid.name, std::string("has no ") + what, "A grid needs at least one");
}

void check_grid(const StudyGrid& grid) {
  require(!grid.scenes.empty(), grid, "scenes");
  require(!grid.recipes.empty(), grid, "recipes");
  require(!grid.rays.empty(), grid, "ray sets");
  require(!grid.seeds.empty(), grid, "seeds");
  require(grid.repeats > 0, grid, "repeats");
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
  make_build_options(recipe.recipe, grid.registry, {&area.area, one});
}

}  // namespace

Study make_study(const StudyGrid& given) {
  check_grid(given);
  const auto grid = std::make_shared<const StudyGrid>(given);
  Study study{grid->name, grid_columns(), {}, identity_of(*grid), grid->missing};
  for (const StudyScene& scene : grid->scenes) {
    const auto lazy = std::make_shared<LazyScene>([grid, load = scene.load] {
      TriangleMesh mesh = load();
      Bvh global = build_global_tree(mesh, grid->global, grid->registry);
      return study::make_scene_trees(std::move(mesh), std::move(global));
    });
    for (const StudyArea& area : scene.areas) {
      const char* kind = std::holds_alternative<PlaneArea>(area.area.shape) ? "plane" : "point";
      for (const StudyRecipe& recipe : grid->recipes) {
        bool checked = false;
        for (const StudyRays& rays : grid->rays) {
          if (grid->leave_out && grid->leave_out(scene, area, recipe, rays)) continue;
          if (!checked) check_recipe(*grid, area, recipe);
          checked = true;
          for (const uint64_t seed : grid->seeds)
            for (uint64_t repeat = 1; repeat <= grid->repeats; ++repeat) {
              const GridRow row{grid, lazy, area, recipe, rays, seed};
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
