// What areas are given to answer their rays, as commands that make an accelerator are told.
#pragma once

#include <span>
#include <string>

#include "raygrain/accelerator.h"

#include "cli/arguments.h"

namespace raygrain::cli {

struct StructureOptions {
  std::string density = "near-plane", space, frame, routing;  // no space: local_space; no routing: the command's own
  bool no_coverage = false;
};
/// Under a title of their own. `usual` is what the command does without --routing.
void add_structure_options(Arguments& arguments, StructureOptions& options, Routing usual);

/// The first of these options that is given, with a value that changes anything; "" without any.
std::string given_structure_option(const StructureOptions& options);

/// Sets what is given in `result`, whose traversal is set. Throws Error (kUsage). Needs no scene, so it can come first.
void set_structures(const StructureOptions& options, AcceleratorOptions& result);

/// Throws Error (kUsage) for what would change nothing about these areas.
void check_structures_of(const StructureOptions& options, std::span<const InfluenceArea> areas);

}  // namespace raygrain::cli
