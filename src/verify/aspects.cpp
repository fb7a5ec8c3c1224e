#include "verify/aspects.h"

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

void add_recipe(const std::string& name, std::set<std::string>& aspects) {
  const Recipe recipe = parse_recipe(name, verify_registry(1));
  aspects.insert({"measure " + recipe.measure, "orientation " + recipe.orientation, "builder " + recipe.builder});
}

/// What is counted for a structure whatever the rays.
std::set<std::string> aspects_of(const StructureSpec& spec) {
  std::set<std::string> aspects{spec.batch > 1 ? "batches" : "calls one by one"};
  const bool is_accelerator = spec.kind == "accelerator";
  if (spec.kind == "binary" || spec.kind == "wide" || is_accelerator) add_recipe(spec.tree, aspects);
  if (is_accelerator && spec.areas) add_recipe(spec.local, aspects);
  const bool has_kernels = spec.kind != "binary" && spec.traversal == "wide";
  if (has_kernels) aspects.insert({"isa " + spec.isa, spec.kind + ", isa " + spec.isa});
  if (spec.kind == "frame") aspects.insert("frame " + spec.frame);
  if (is_accelerator && spec.areas) aspects.insert(spec.ray_space ? "local trees in ray space" : "local trees");
  if (is_accelerator && has_kernels && spec.areas && spec.covered) aspects.insert("accelerators with coverage");
  if (spec.threads != 1) aspects.insert("several threads");
  if (spec.reinserted) aspects.insert("reinserted");
  if (spec.refitted) aspects.insert("refitted");
  if (spec.from_file) aspects.insert("read from a file");
  return aspects;
}

}  // namespace

std::vector<std::string> aspects_of(const std::string& structure, RayGroupKind rays) {
  try {
    const StructureSpec spec = parse_spec(structure);
    if (spec.kind == "exact") return {"exact" + text_of(rays)};
    const std::set<std::string> aspects = aspects_of(spec);
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
