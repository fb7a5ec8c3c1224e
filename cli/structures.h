// What areas are given to answer their rays, as commands that make an accelerator are told.
#pragma once

#include <string>

#include "raygrain/accelerator.h"

#include "cli/arguments.h"

namespace raygrain::cli {

struct StructureOptions {
  std::string space = "world";
};
/// Under a title of their own.
void add_structure_options(Arguments& arguments, StructureOptions& options);

/// Throws Error (kUsage). Needs no scene, so it can come first.
void set_structures(const StructureOptions& options, AcceleratorOptions& result);

}  // namespace raygrain::cli
