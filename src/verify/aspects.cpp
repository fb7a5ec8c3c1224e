#include "verify/aspects.h"

#include <algorithm>
#include <set>

#include "raygrain/error.h"

#include "verify/spec.h"

namespace raygrain::verification {
namespace {

std::string text_of(RayGroupKind rays) {
  switch (rays) {
    case RayGroupKind::kMixed:
      return ", mixed rays";
    case RayGroupKind::kDirection:
      return ", rays of one direction";
    case RayGroupKind::kFrom:
      return ", rays from one point";
    case RayGroupKind::kTowards:
      return ", rays to one point";
  }
  return {};
}

using Aspects = std::set<std::string>;

void add_recipe(const StructureSpec& spec, const Recipe& recipe, Aspects& aspects) {
  aspects.insert({"measure " + recipe.measure, "orientation " + recipe.orientation, "builder " + recipe.builder});
  if (recipe.measure == "VISIBLE") aspects.insert(spec.kind + ", measure VISIBLE");
}

/// What makes wide forms, where it is no tree's own measure.
void add_wide_measure(const StructureSpec& spec, const std::string& measure, Aspects& aspects) {
  aspects.insert("wide forms by " + measure);
  if (measure == "VISIBLE") aspects.insert(spec.kind + ", wide forms by VISIBLE");
}

void add_tree(const StructureSpec& spec, const VerifyScene& scene, Aspects& aspects) {
  const Recipe recipe = tree_recipe(spec, scene);
  add_recipe(spec, recipe, aspects);
  if (spec.reinserted) aspects.insert("reinserted by " + (spec.by_own_measure ? recipe.measure : std::string("SAH")));
  if (spec.kind != "wide" || spec.wide_measure.empty()) return;
  StructureSpec wide = spec;
  wide.tree = spec.wide_measure + "+ALL";
  add_wide_measure(spec, tree_recipe(wide, scene).measure, aspects);
}

void add_solid_angle(const StructureSpec& spec, Aspects& aspects) {
  aspects.insert({"density solid-angle", spec.kind + ", density solid-angle"});
}

bool is_point(const InfluenceArea& area) {
  return std::holds_alternative<PointArea>(area.shape);
}

void add_local_trees(const StructureSpec& spec, const VerifyScene& scene, Aspects& aspects) {
  const Recipe recipe = parse_recipe(spec.local, verify_registry(spec.seed));
  add_recipe(spec, recipe, aspects);
  aspects.insert(spec.ray_space ? "local trees in ray space" : "local trees");
  if (spec.reinserted_local) aspects.insert({"local trees, reinserted", "reinserted by " + recipe.measure});
  if (!spec.wide_measure.empty()) add_wide_measure(spec, spec.wide_measure, aspects);
  if (!spec.area_frame.empty()) aspects.insert("local trees in ray space, frame " + spec.area_frame);
  const bool has_points = std::ranges::any_of(accelerator_areas(spec, scene), is_point);
  if (spec.ray_space && spec.solid_angle && has_points) add_solid_angle(spec, aspects);
}

void add_accelerator(const StructureSpec& spec, const VerifyScene& scene, Aspects& aspects) {
  Recipe global = parse_recipe(spec.tree, verify_registry(spec.seed));
  if (!spec.quality.empty()) {
    set_quality(global, parse_quality(spec.quality));
    aspects.insert("quality " + spec.quality);
  }
  add_recipe(spec, global, aspects);
  if (spec.reinserted) aspects.insert("reinserted by " + global.measure);
  if (accelerator_areas(spec, scene).empty()) return;
  if (spec.local_trees) add_local_trees(spec, scene, aspects);
  if (!spec.local_trees) aspects.insert("accelerators without local trees");
  if (spec.traversal == "wide" && spec.covered) aspects.insert("accelerators with coverage");
}

/// What is counted for a structure whatever the rays.
Aspects aspects_of(const StructureSpec& spec, const VerifyScene& scene) {
  Aspects aspects{spec.batch > 1 ? "batches" : "calls one by one"};
  if (spec.kind == "binary" || spec.kind == "wide") add_tree(spec, scene, aspects);
  if (spec.kind == "accelerator") add_accelerator(spec, scene, aspects);
  const bool has_kernels = spec.kind != "binary" && spec.traversal == "wide";
  if (has_kernels) aspects.insert({"isa " + spec.isa, spec.kind + ", isa " + spec.isa});
  if (spec.kind == "frame") aspects.insert("frame " + spec.frame);
  if (spec.kind == "frame" && spec.solid_angle && spec.frame == name(FrameKind::kProjective))
    add_solid_angle(spec, aspects);
  if (spec.threads != 1) aspects.insert("several threads");
  if (spec.reinserted || spec.reinserted_local) aspects.insert("reinserted");
  if (spec.refitted) aspects.insert("refitted");
  if (spec.from_file) aspects.insert("read from a file");
  return aspects;
}

}  // namespace

std::vector<std::string> aspects_of(const std::string& structure, const VerifyScene& scene, RayGroupKind rays) {
  try {
    const StructureSpec spec = parse_spec(structure);
    if (spec.kind == "exact") return {"exact" + text_of(rays)};
    const Aspects aspects = aspects_of(spec, scene);
    std::vector<std::string> result(aspects.begin(), aspects.end());
    result.push_back(spec.kind + text_of(rays));
    return result;
  } catch (const Error&) {
    return {"own structures" + text_of(rays)};
  }
}

std::vector<std::string> aspects_told(const std::string& structure, uint8_t told) {
  std::vector<std::string> aspects;
  const std::string kind = structure.substr(0, structure.find(' '));
  if ((told & RayAnswers::kColumn) != 0) aspects.push_back("columns");
  if ((told & RayAnswers::kCone) != 0) aspects.push_back("cones");
  if ((told & RayAnswers::kBatch) != 0) aspects.push_back(kind + ": batch");
  if (kind == "coverage" && (told & RayAnswers::kBatch) == 0) aspects.push_back("coverage: single");
  return aspects;
}

}  // namespace raygrain::verification
