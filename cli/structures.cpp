#include "cli/structures.h"

#include "cli/values.h"

namespace raygrain::cli {

namespace {

LocalSpace parse_space(const std::string& name) {
  if (name == "none") return LocalSpace::kNone;
  if (name == "world") return LocalSpace::kWorld;
  if (name == "ray") return LocalSpace::kRay;
  fail_usage("--space", "unknown space '" + name + "'", "Known: none, world, ray");
}

}  // namespace

void add_structure_options(Arguments& arguments, StructureOptions& options) {
  arguments.group("Structures");
  arguments.text("--space", "NAME", options.space,
                 "Space of the areas' trees: world, ray (both), or none for coverage alone [world]");
}

void set_structures(const StructureOptions& options, AcceleratorOptions& result) {
  result.space = parse_space(options.space);
}

}  // namespace raygrain::cli
