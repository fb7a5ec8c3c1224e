#include <filesystem>
#include <memory>

#include <unistd.h>

#include "raygrain/accelerator.h"
#include "raygrain/io.h"
#include "raygrain/rays.h"
#include "raygrain/refine.h"

#include "verify/spec.h"

namespace raygrain::verification {
namespace {

/// The mesh before its vertices moved: each somewhere near where it is now.
TriangleMesh shaken(const TriangleMesh& mesh, uint64_t seed) {
  TriangleMesh result = mesh;
  const Bounds box = mesh_bounds(mesh);
  Random random(seed);
  for (Vec3& vertex : result.vertices)
    for (int k = 0; k < 3; ++k) {
      const double size = static_cast<double>(box.hi[k]) - static_cast<double>(box.lo[k]);
      const double moved = static_cast<double>(vertex[k]) + size * random.uniform(-0.3, 0.3);
      if (std::abs(moved) < 3e38) vertex[k] = static_cast<float>(moved);
    }
  return result;
}

/// Written to a file of its own and read back.
Bvh through_a_file(const Bvh& tree) {
  std::string pattern = (std::filesystem::temp_directory_path() / "raygrain-verify-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) return tree;
  struct Remover {
    std::string folder;
    ~Remover() {
      std::error_code ignored;
      std::filesystem::remove_all(folder, ignored);
    }
  } const remover{pattern};
  save_tree(tree, pattern + "/tree.rgt");
  return load_tree(pattern + "/tree.rgt");
}

/// An area that the recipe is valid for: DIR is about plane areas only.
const InfluenceArea* fitting_area(const StructureSpec& spec, const VerifyScene& scene, const Recipe& recipe) {
  const InfluenceArea* area = area_of(spec, scene);
  if (recipe.measure != "DIR" || area == nullptr || std::holds_alternative<PlaneArea>(area->shape)) return area;
  for (const InfluenceArea& other : scene.areas)
    if (std::holds_alternative<PlaneArea>(other.shape)) return &other;
  return nullptr;
}

}  // namespace

const InfluenceArea* area_of(const StructureSpec& spec, const VerifyScene& scene) {
  return scene.areas.empty() ? nullptr : &scene.areas[spec.area % scene.areas.size()];
}

std::vector<Ray> samples_of(const StructureSpec& spec, const InfluenceArea* area) {
  constexpr size_t kCount = 64;
  return area != nullptr ? cast_rays(AreaRays{*area}, kCount, spec.seed) : std::vector<Ray>{};
}

Recipe tree_recipe(const StructureSpec& spec, const VerifyScene& scene) {
  const Registry registry = verify_registry(spec.seed);
  Recipe recipe = parse_recipe(spec.tree, registry);
  recipe.for_wide = spec.for_wide;
  if (fitting_area(spec, scene, recipe) == nullptr && (needs_area(recipe, registry) || needs_samples(recipe, registry)))
    recipe.measure = "SAH", recipe.orientation = "ALL";
  return recipe;
}

Bvh make_tree(const StructureSpec& spec, const VerifyScene& scene) {
  const Registry registry = verify_registry(spec.seed);
  const Recipe recipe = tree_recipe(spec, scene);
  const InfluenceArea* area = fitting_area(spec, scene, recipe);
  const TriangleMesh& mesh = *scene.mesh;
  const TriangleMesh built_for = spec.refitted ? shaken(mesh, spec.seed) : mesh;
  const std::vector<Ray> samples = samples_for(recipe, registry, samples_of(spec, area), built_for);
  const ClipPrimitive clip = [&](uint32_t i, const Bounds& box) { return clip_triangle_bounds(built_for, i, box); };
  const HeuristicInput input{area, samples, clip};
  Bvh tree = build_tree(recipe, registry, input, triangle_bounds(built_for), triangle_centroids(built_for), nullptr,
                        {spec.threads, {}});
  if (spec.reinserted) {
    const RayMeasure measure =
        spec.by_own_measure ? make_build_options(recipe, registry, input).strategy.measure : RayMeasure();
    reinsert(tree, measure, {.threads = spec.threads});
  }
  if (spec.refitted) refit(tree, triangle_bounds(mesh));
  return spec.from_file ? through_a_file(tree) : tree;
}

RayMeasure wide_measure(const StructureSpec& spec, const VerifyScene& scene) {
  if (spec.wide_measure.empty()) return {};
  const Registry registry = verify_registry(spec.seed);
  StructureSpec wide = spec;
  wide.tree = spec.wide_measure + "+ALL";
  const Recipe recipe = tree_recipe(wide, scene);
  const InfluenceArea* area = fitting_area(spec, scene, recipe);
  const std::vector<Ray> samples = samples_for(recipe, registry, samples_of(spec, area), *scene.mesh);
  return make_build_options(recipe, registry, {area, samples}).strategy.measure;
}

}  // namespace raygrain::verification
