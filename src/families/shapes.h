// The shapes that families of meshes are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "raygrain/families.h"

#include "base/random.h"

namespace raygrain::shapes {

Vec3d random_point(Random& random, double half_size);

/// Coordinates with few bits, so that many rays meet edges and vertices exactly.
Vec3d snapped(Vec3d p, double unit);

Vec3 clamped_to_float(Vec3d p);

/// Vertices and the inside point go through `map`, in double, and are rounded (and kept finite) once.
template <class Map>
NamedMesh mapped(std::string name, NamedMesh source, const Map& map) {
  for (Vec3& vertex : source.mesh.vertices) vertex = clamped_to_float(map(to_double(vertex)));
  source.inside = clamped_to_float(map(to_double(source.inside)));
  source.name = std::move(name);
  return source;
}

NamedMesh turned(std::string name, NamedMesh source, Random& random);
NamedMesh moved(std::string name, NamedMesh source, double scale, Vec3d offset);

// --- Closed, around the origin, about as large as [-1, 1]^3. ---

/// The surface of the cube, each face cut into n x n squares of two triangles; vertices are shared.
NamedMesh closed_box(int n);
NamedMesh closed_sphere(int n);
/// Star-shaped about its centre; coordinates are multiples of 2^-10.
NamedMesh noise_sphere(int n, Random& random);
NamedMesh closed_torus(uint32_t around, uint32_t across);
/// Triangles are cut in three and edges in two again and again, nearly at their corners and edges: slivers as thin as
/// Boolean operations leave. The surface stays closed, and where it was but for rounding. At least `triangles`.
NamedMesh with_slivers(NamedMesh source, size_t triangles, Random& random);

// --- Open. ---

/// A height field over [-1, 1]^2; heights are multiples of 2^-6 and many squares are flat.
NamedMesh open_grid(uint32_t n, Random& random);
NamedMesh one_triangle();
NamedMesh soup(std::string name, size_t count, double size, Random& random);
NamedMesh snapped_soup(size_t count, Random& random);
/// Every coordinate with an exponent of its own, between the denormals and FLT_MAX.
NamedMesh mixed_exponents(size_t count, Random& random);
NamedMesh slivers(size_t count, Random& random);
/// Points, segments and repeated vertices, every third triangle good.
NamedMesh degenerate(size_t count, Random& random);
/// `count` triangles, then three times as many copies, some with the winding reversed or the corners turned.
NamedMesh duplicates(size_t count, Random& random);
/// Many large layers on top of each other, some of them twice, in planes of an axis or not.
NamedMesh layers(size_t count, Random& random);
/// All triangles share one vertex.
NamedMesh fan(size_t count, Random& random);

}  // namespace raygrain::shapes
