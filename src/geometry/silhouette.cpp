// The outlines of a box from all sides, generated from the cube's topology: Schmalstieg and Tobler, "Fast projected
// area computation for three-dimensional bounding boxes" (1999); algorithms 2 and 3 of "Ray Distribution Aware
// Heuristics for Bounding Volume Hierarchies Construction in Ray Tracing" (2024).
#include <array>

#include "raygrain/area.h"

namespace raygrain {

namespace {

constexpr unsigned kFaceSets = 43;  // the largest set is x=hi, y=hi, z=hi: 0b101010 = 42

struct Outline {
  std::array<int, 6> corners{};
  size_t count = 0;
};

// The corners of a face in the order that runs counterclockwise for someone who looks at it from inside the box.
constexpr std::array<int, 4> face_loop(int face) {
  const int axis = face / 2, side = (face & 1) << axis;
  const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3);
  if (side == 0) return {0, u, u | v, v};
  return {side, side | v, side | u | v, side | u};
}

// Edges between two visible faces run both ways and cancel; what is left is the outline.
constexpr Outline make_outline(unsigned faces) {
  std::array<int, 8> next{};
  for (int& corner : next) corner = -1;
  bool edges[8][8] = {};
  for (int face = 0; face < 6; ++face) {
    if (!(faces >> face & 1)) continue;
    const std::array<int, 4> loop = face_loop(face);
    for (size_t i = 0; i < 4; ++i) edges[loop[i]][loop[(i + 1) % 4]] = true;
  }
  int first = -1;
  for (int from = 0; from < 8; ++from)
    for (int to = 0; to < 8; ++to)
      if (edges[from][to] && !edges[to][from]) {
        next[static_cast<size_t>(from)] = to;
        if (first < 0) first = from;
      }
  Outline outline;
  for (int corner = first; first >= 0;) {
    outline.corners[outline.count++] = corner;
    corner = next[static_cast<size_t>(corner)];
    if (corner == first) break;
  }
  return outline;
}

constexpr bool is_possible(unsigned faces) {
  return faces < kFaceSets && (faces & 3) != 3 && (faces & 12) != 12 && (faces & 48) != 48;
}

constexpr std::array<Outline, kFaceSets> make_table() {
  std::array<Outline, kFaceSets> table;
  for (unsigned faces = 0; faces < kFaceSets; ++faces)
    if (is_possible(faces)) table[faces] = make_outline(faces);
  return table;
}

constexpr std::array<Outline, kFaceSets> kOutlines = make_table();

}  // namespace

std::span<const int> contour_corners(unsigned visible_faces) {
  if (visible_faces >= kFaceSets) return {};
  return {kOutlines[visible_faces].corners.data(), kOutlines[visible_faces].count};
}

// Without branches: builders ask for boxes on all sides in random order.
unsigned visible_faces_along(Vec3d direction) {
  unsigned faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto lo = static_cast<unsigned>(direction[axis] > 0), hi = static_cast<unsigned>(direction[axis] < 0);
    faces |= (lo | hi << 1) << (2 * axis);
  }
  return faces;
}

unsigned visible_faces_from(Vec3d eye, const Bounds& box) {
  unsigned faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto lo = static_cast<unsigned>(eye[axis] < static_cast<double>(box.lo[axis]));
    const auto hi = static_cast<unsigned>(eye[axis] > static_cast<double>(box.hi[axis]));
    faces |= (lo | hi << 1) << (2 * axis);
  }
  return faces;
}

}  // namespace raygrain
