// Structures as plain data: drawn at random, written as their names, read again from them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "raygrain/accelerator.h"
#include "raygrain/coverage.h"
#include "raygrain/ray_frame.h"
#include "raygrain/registry.h"
#include "raygrain/verify.h"
#include "raygrain/wide.h"

#include "base/random.h"

namespace raygrain::verification {

/// Fields that a kind does not read keep their default and are not in the name.
struct StructureSpec {
  std::string kind = "wide";                                      // binary, wide, frame, coverage, accelerator
  std::string tree = "SAH+ALL@binned", local = "PAH+ALL@binned";  // recipes
  bool for_wide = false, reinserted = false, refitted = false, from_file = false;
  bool by_own_measure = false;  // binary, wide: reinserted under the tree's measure, else under surface area
  uint32_t area = 0;            // which of the scene's, modulo their number
  uint32_t leaf = 8;            // triangles, of wide trees
  std::string isa = "scalar";
  std::string frame = "shear_y";
  bool of_area = false, spatial = true;  // frame: of the area, or of its direction alone
  bool areas = true, octree = true, ray_space = false, covered = true;
  bool local_trees = true, reinserted_local = false;
  std::string wide_measure;  // of wide forms; empty: an accelerator's as its trees', of wide trees surface area
  std::string area_frame;    // of an accelerator's areas; empty: the cheapest
  std::string quality;       // of an accelerator's global tree; empty: as its recipe says
  bool solid_angle = false;  // trees in ray space: for isotropic light, where rays go through a point
  std::string traversal = "wide";
  float cells = 0.25f;  // of coverages
  uint32_t tile = 256;
  std::string order = "chosen";
  uint32_t batch = 0;  // rays per call; 0: one ray at a time
  uint32_t threads = 1;
  bool counted = false, unpruned = false;
  uint64_t seed = 1;
};

StructureSpec random_spec(Random& random);
std::string to_text(const StructureSpec& spec);
/// Throws Error (kUsage).
StructureSpec parse_spec(const std::string& text);

/// Throws Error (kUsage) for an unknown name.
Isa parse_isa(const std::string& name);
CoverageOrder parse_order(const std::string& name);
FrameKind parse_frame(const std::string& name);

/// The library's own, and "RANDOM": a measure that is not monotone and knows no reason, for trees of any shape.
Registry verify_registry(uint64_t seed);

/// Of each kind; see RayStructure::make.
AnswerRays make_binary(const StructureSpec& spec, const VerifyScene& scene);
AnswerRays make_wide(const StructureSpec& spec, const VerifyScene& scene);
AnswerRays make_frame(const StructureSpec& spec, const VerifyScene& scene);
AnswerRays make_coverage(const StructureSpec& spec, const VerifyScene& scene);
AnswerRays make_accelerator(const StructureSpec& spec, const VerifyScene& scene);

/// No structure: the definition of a hit in integers of any size (intersect_triangle_exact), for one ray in 128 of a
/// group.
AnswerRays make_exact(const StructureSpec& spec, const VerifyScene& scene);

/// The binary tree that a spec asks for.
Bvh make_tree(const StructureSpec& spec, const VerifyScene& scene);
/// What it is made by: the spec's recipe, or SAH+ALL where the scene has no area that the recipe is for.
Recipe tree_recipe(const StructureSpec& spec, const VerifyScene& scene);
/// What wide trees are made by: surface area where the spec says nothing, or the scene has no area for its measure.
RayMeasure wide_measure(const StructureSpec& spec, const VerifyScene& scene);

AcceleratorOptions accelerator_options(const StructureSpec& spec);
/// The scene's areas that an accelerator is made with: DIR is about plane areas only.
std::vector<InfluenceArea> accelerator_areas(const StructureSpec& spec, const VerifyScene& scene);

/// Null for a scene without areas.
const InfluenceArea* area_of(const StructureSpec& spec, const VerifyScene& scene);
/// Of the area, drawn by the seed; not ended yet.
std::vector<Ray> samples_of(const StructureSpec& spec, const InfluenceArea* area);

}  // namespace raygrain::verification
