// The one table that turns names into measures, orientations and builders, for command line, studies and bindings.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/build.h"
#include "raygrain/heuristics.h"

namespace raygrain {

/// What a named heuristic may be made for. `area` may be null (global trees); `samples` may be empty. `clip` cuts the
/// primitives, for builders that need it.
struct HeuristicInput {
  const InfluenceArea* area = nullptr;
  std::span<const Ray> samples = {};
  ClipPrimitive clip = {};
};

struct MeasureEntry {
  std::string name, description;
  bool needs_area = false, needs_samples = false;
  std::function<RayMeasure(const HeuristicInput&)> make;
  bool needs_hits = false;  // its samples must know their first hit: it is their tmax
};

struct OrientationEntry {
  std::string name, description;
  bool needs_area = false;
  bool all_axes = false;  // every axis admissible, excellent threshold 0
  std::function<SplitOrientation(const HeuristicInput&)> make;
};

/// How much time a tree is worth, by the builder that makes it: subset, binned, spatial.
enum class Quality { kFast, kBalanced, kBest };

/// "subset", "binned" or "spatial".
const char* builder_name(Quality quality);

/// fast, balanced or best. Throws Error (kUsage) for anything else.
Quality parse_quality(std::string_view text);

using BuildFunction = Bvh (*)(std::span<const Bounds>, std::span<const Vec3>, const BuildOptions&, BuildLog*);

/// Where a triangle stands when it is sorted to a side of a plane.
enum class Centres {
  kBarycentre,  // as in Algorithm 1
  kBox,         // the center of its box: trees of lower cost where triangles are long (city 94 -> 75 under SAH)
};

struct BuilderEntry {
  std::string name, description;
  BuildFunction build = nullptr;
  Centres centres = Centres::kBarycentre;
};

/// A value: copy the default one and add rows to it to make own heuristics available by name.
struct Registry {
  std::vector<MeasureEntry> measures;          // SAH, PAH, PAH-UNCULLED, DIR, SOLID, SAMPLED, VISIBLE
  std::vector<OrientationEntry> orientations;  // LSPH, SPFH, ALL, ROBIN
  std::vector<BuilderEntry> builders;          // paper, binned, sweep, spatial, subset
};

Registry default_registry();

/// A tree by name: MEASURE+ORIENTATION or MEASURE+ORIENTATION@BUILDER, e.g. "PAH+SPFH", "SAH+ALL@binned".
struct Recipe {
  std::string measure = "SAH", orientation = "ALL", builder = "paper";
  PaperParameters parameters;
  /// Made to be searched as a wide tree: 32 bins, and nodes of up to 8 triangles that few rays meet are not split
  /// (BuildOptions::rare_leaf_size). No part of the name. Not for `paper`.
  bool for_wide = false;
};

/// Builds for a quality: its builder, for_wide; and for kFast only the longest axis of each node, as Wald (2007) does,
/// where the recipe says ALL: two thirds of the work of a split are the other axes.
void set_quality(Recipe& recipe, Quality quality);

/// "MEASURE+ORIENTATION", with "@BUILDER" unless it is `paper`.
std::string recipe_name(const Recipe& recipe);

/// Throws Error (kUsage) that lists what is known and names the nearest match, for text that is no recipe.
/// Case-insensitive.
Recipe parse_recipe(std::string_view text, const Registry& registry);

bool needs_area(const Recipe& recipe, const Registry& registry);
bool needs_samples(const Recipe& recipe, const Registry& registry);
bool needs_hits(const Recipe& recipe, const Registry& registry);

/// Options of the preset `paper`: the recipe's measure and orientation, fallback SAH + LSPH, all thresholds from
/// recipe.parameters ("+ALL": quality threshold 0 and excellent ratio 0); `binned` merges leaves. Throws Error (kUsage)
/// when the recipe needs an area or samples and there are none, or when its measure cannot serve the area (DIR: only
/// plane areas).
BuildOptions make_build_options(const Recipe& recipe, const Registry& registry, const HeuristicInput& input);

/// Does the recipe's builder look at centroids (Centres::kBarycentre)?
bool needs_centroids(const Recipe& recipe, const Registry& registry);

/// Builds the recipe's tree. `centroids` may be empty, and are not looked at, where needs_centroids says so. Throws
/// Error: as make_build_options and the builder; kCancelled.
Bvh build_tree(const Recipe& recipe, const Registry& registry, const HeuristicInput& input,
               std::span<const Bounds> bounds, std::span<const Vec3> centroids, BuildLog* log = nullptr,
               const BuildRun& run = {});

}  // namespace raygrain
