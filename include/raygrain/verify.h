// Verification: random scenes and hard rays through every kind of structure, each answer compared bit by bit with
// brute force; what differs is made small and saved as a scene that anybody can run again.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/scene.h"

namespace raygrain {

// --- What is asked, and who answers. ---

/// What a structure is made for.
struct VerifyScene {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<InfluenceArea> areas;
};

enum class RayGroupKind {
  kMixed,      // rays of any kind
  kDirection,  // they share the direction; tmin 0, tmax infinite
  kFrom,       // they share the origin; tmin 0, tmax infinite
  kTowards,    // direction float32(shared - origin), tmin 0, tmax 1
};

/// Rays that are asked together.
struct RayGroup {
  RayGroupKind kind = RayGroupKind::kMixed;
  Vec3 shared{};  // direction, origin or target
  std::vector<Ray> rays;
  bool must_hit = false;  // rays from inside a closed mesh
};

/// Where a structure writes what it knows; all have the size of the group's rays.
struct RayAnswers {
  static constexpr uint8_t kNearest = 1, kAny = 2;
  static constexpr uint8_t kColumn = 4, kCone = 8, kBatch = 16;  // how, where a structure says so: for counts alone

  std::span<Hit> nearest;
  std::span<uint8_t> any;   // 1: there is a hit
  std::span<uint8_t> told;  // which of these two were answered, and how; 0 before
  /// Answers are about the ray as far as it reaches up to this t; infinity before.
  std::span<float> until;
};

using AnswerRays = std::function<void(const RayGroup&, const RayAnswers&)>;

/// Something that answers rays. The name of one of raygrain's own says all about it: see parse_structure.
struct RayStructure {
  std::string name;
  /// Nothing where there can be no such structure for this scene (no frame suits it, say). Called from any thread.
  std::function<AnswerRays(const VerifyScene&)> make;
};

/// One of raygrain's structures, chosen by the seed: binary and wide trees of any builder, measure and orientation,
/// reinserted under that measure or another, refitted, or read from a file, with wide forms by any measure; trees in
/// ray space; coverages; accelerators with areas and without, in every LocalSpace, with any frame, quality, measure of
/// wide forms and reinsertion; each on any instruction set of this CPU, asked ray by ray or in batches of any size, on
/// one thread or several.
RayStructure random_structure(uint64_t seed);

/// From a name that random_structure gave, e.g. "wide tree=PAH+SPFH@spatial leaf=3 isa=avx2 batch=7". Throws Error
/// (kUsage).
RayStructure parse_structure(const std::string& name);

// --- Running it. ---

/// Sums of a run.
struct VerifyTally {
  uint64_t scenes = 0, structures = 0;  // `structures` were made over all scenes
  uint64_t rays = 0, hits = 0;
  uint64_t comparisons = 0;  // answers of structures: nearest hits and yes-or-no
  uint64_t oracle_rays = 0;  // of the rays, those that brute force answered too
  uint64_t differences = 0;  // answers with any bit wrong, and structures that could not be made
  uint64_t inside_rays = 0;  // rays from inside closed meshes: each must hit
  uint64_t lines = 0;        // lines that touch no edge of closed meshes: each must cross an even number of times
  uint64_t leaks = 0;        // of the last two, those that did not
  double seconds = 0;
  /// Of the comparisons, those of structures and rays with something in common, e.g. "wide, mixed rays", "isa avx2",
  /// "measure PAH", "wide, measure VISIBLE", "wide forms by VISIBLE", "accelerators without local trees", "builder
  /// spatial", "frame shear_y", "batches", "columns"; each comparison is in several. An accelerator's are counted under
  /// all that it has, whichever of it answered.
  std::map<std::string, uint64_t> comparisons_of;

  void add(const VerifyTally& other);
  bool is_good() const { return differences == 0 && leaks == 0; }
};

/// "verified: 1234567 rays, 9876543 comparisons, 1234567 by brute force, 0 differences, 0 leaks (12.3 s, ...)".
std::string to_text(const VerifyTally& tally);

/// What differed, made small.
struct VerifyFailure {
  std::string structure;
  std::string what;  // for people
  Scene scene;       // mesh, areas and one set of rays, one of which fails; its name is the structure's
  std::string path;  // of the saved scene; empty where none was saved
};

struct VerifyOptions {
  uint64_t rays = 10'000'000;                                // at least so many
  double seconds = std::numeric_limits<double>::infinity();  // but no longer than about this
  uint64_t seed = 1;
  unsigned threads = 0;            // 0 = all; with the same `rays` nothing depends on it but the time
  std::vector<Scene> scenes;       // taken in turns with random ones; their own rays are asked too
  uint64_t most_triangles = 2000;  // up to so many every ray goes to brute force; beyond, one in a thousand
  uint32_t structures_per_scene = 3;
  /// Rays of a scene times its triangles, about: with more, less time goes into making scenes and structures.
  uint64_t tests_per_scene = 4'000'000;
  std::vector<RayStructure> structures;              // asked about every scene, besides
  std::string folder;                                // where failures are saved; empty: nowhere
  size_t most_failures = 8;                          // made small and kept; more are only counted
  std::function<bool()> stop;                        // asked now and then from any thread; true ends the run early
  std::function<void(const VerifyTally&)> progress;  // sums so far, never by two threads at once
};

struct VerifyResult {
  VerifyTally tally;
  std::vector<VerifyFailure> failures;
};

/// Throws Error: kUsage (nothing to do), kUnwritable.
VerifyResult verify(const VerifyOptions& options);

/// The scene's own rays through these structures, against brute force; nothing random, nothing made small.
VerifyResult verify_scene(const Scene& scene, std::span<const RayStructure> structures);

}  // namespace raygrain
