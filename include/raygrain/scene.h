// Scenes: a mesh, its influence areas and its ray sets, from a mesh file, a scene.json or a recipe for a procedural
// one.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/rays.h"

namespace raygrain {

/// Named rays of a scene: a caster with its count and seed, or rays as they are.
struct RaySet {
  std::string name;
  std::variant<AreaRays, SurfaceRays, CameraRays, std::vector<Ray>> source;
  size_t count = 10000;
  uint64_t seed = 1;
};

/// The set's rays (surface rays need the mesh).
std::vector<Ray> make_rays(const RaySet& set, const TriangleMesh& mesh);

struct Scene {
  std::string name;
  TriangleMesh mesh;
  std::vector<InfluenceArea> areas;
  std::vector<RaySet> ray_sets;
  size_t dropped_lines = 0, dropped_points = 0;  // primitives of the files that are no polygons
};

/// Parameters of a procedural scene; y is up, units are metres.
struct ProceduralOptions {
  std::string kind = "city";  // city | forest | terrain | random100 | random1000
  uint32_t size = 0;  // blocks, trees or cells per side; 0 = the kind's default; ignored by random100 and random1000
  uint64_t seed = 1;
};

/// city: blocks of boxes with roofs on a street grid; forest: trees of cones and leaf triangles on rolling ground;
/// terrain: a height field; random100, random1000: the random triangles of the paper's tests (std::mt19937 of seed 1).
/// Each has one sun area named "sun". Throws Error (kUsage) for unknown kinds or sizes out of range.
Scene generate_scene(const ProceduralOptions& options);

/// "procedural:KIND?size=N&seed=S"; throws Error (kUsage) with what is known.
ProceduralOptions parse_procedural(const std::string& text);

}  // namespace raygrain
