// The tree that the commands build and analyze work with: of one area, or of the whole scene.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/fields.h"
#include "raygrain/report.h"
#include "raygrain/scene.h"

#include "cli/areas.h"
#include "cli/open_scene.h"

namespace raygrain::cli {

struct TreeOptions {
  CommonOptions common;
  AreaOptions areas;
  std::string scene, recipe, area;  // area: a name, or empty
  bool whole = false;               // of the whole scene, whatever areas there are
  std::string quality;              // replaces the recipe's builder; or empty
  bool reinsert = false;
  std::string file;  // of a built tree, to be taken instead of a new one; or empty
  uint64_t seed = 1;
};
void add_tree_options(Arguments& arguments, TreeOptions& options);

/// A tree and what it was made for.
struct OneTree {
  Recipe recipe;
  Registry registry;
  std::optional<InfluenceArea> area;  // none: all triangles of the scene
  std::vector<Ray> samples;           // of the area, for recipes that need them
  std::shared_ptr<const Bvh> tree;
  BuildLog log;        // empty for a tree of a file; without nodes where reinsertion moved them
  std::string file;    // that it came from; or empty
  double seconds = 0;  // to build it

  RayMeasure measure() const;
  /// Everything that is known without tracing rays.
  ReportRow row() const;
  /// The memory that the build took, as a line of text; empty where the builder does not say.
  std::string peak_line() const;
  /// A line of text where the recipe asks what its sample rays hit and none hits anything; else empty.
  std::string sample_line() const;
};

/// Checks what can be checked before the scene is loaded.
Recipe check_tree_options(const TreeOptions& options, const Registry& registry);

/// Leaves its progress on the line. Throws Error (kUsage) when the recipe needs an area and none or several are there.
OneTree build_one_tree(const TreeOptions& options, const Scene& scene, const std::vector<InfluenceArea>& areas,
                       Progress& progress);

}  // namespace raygrain::cli
