// Scenes: a mesh, its influence areas and its ray sets, from a mesh file, a scene.json or a recipe for a procedural
// one.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/bounds.h"
#include "raygrain/mesh.h"
#include "raygrain/rays.h"

namespace raygrain {

/// Named rays of a scene: a caster with its count and seed, or rays as they are.
struct RaySet {
  std::string name;
  std::variant<AreaRays, SurfaceRays, CameraRays, std::vector<Ray>> source;
  size_t count = 10000;  // for areas and surfaces: a camera has a ray per pixel, and a list what it holds
  uint64_t seed = 1;
};

/// The set's rays (surface rays need the mesh).
std::vector<Ray> make_rays(const RaySet& set, const TriangleMesh& mesh);

/// How many rays make_rays gives, without making them; surface rays may be none where the mesh has no area.
size_t ray_count(const RaySet& set);

struct Scene {
  std::string name;
  TriangleMesh mesh;
  std::vector<InfluenceArea> areas;
  std::vector<RaySet> ray_sets;
  size_t dropped_lines = 0, dropped_points = 0;  // primitives of the files that are no polygons
};

/// Parameters of a procedural scene; y is up, units are metres, the ground's middle is the origin.
///
/// | kind    | size is                | default | greatest | triangles       | about 100,000 | about 1,000,000 |
/// |---------|------------------------|---------|----------|-----------------|---------------|-----------------|
/// | city    | buildings per side     | 8       | 150      | about 440 size² | 15            | 48              |
/// | forest  | trees per side         | 8       | 150      | about 420 size² | 16            | 49              |
/// | terrain | cells per side of 1 km | 100     | 7000     | 2 size²         | 224           | 708             |
struct ProceduralOptions {
  std::string kind = "city";  // city | forest | terrain | random100 | random1000
  uint32_t size = 0;          // 0 = the kind's default; ignored by random100 and random1000
  uint64_t seed = 1;          // random100 and random1000: of their std::mt19937, at most 2^32 - 1; 1 in the paper
};

/// city: blocks of buildings with flat, gabled and stepped roofs on a street grid; forest: trees with many leaf
/// triangles on rolling ground; terrain: mountains as a height field; random100, random1000: the random triangles of
/// the paper's tests. Each has one sun area and one set of 10,000 matched rays, both named "sun". The same options give
/// the same bytes on every machine. Throws Error (kUsage) for unknown kinds, sizes or seeds out of range.
Scene generate_scene(const ProceduralOptions& options);

/// "procedural:KIND?size=N&seed=S", each parameter optional; throws Error (kUsage) with what is known.
ProceduralOptions parse_procedural(const std::string& text);

/// As load_areas(path) of io.h, but the shorthands "sun", "light" and "camera" are made to fit `scene`, so that a file
/// of areas alone may use them.
std::vector<InfluenceArea> load_areas(const std::string& path, const Bounds& scene);

}  // namespace raygrain
