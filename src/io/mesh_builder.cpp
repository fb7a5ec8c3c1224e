#include "io/mesh_builder.h"

#include "raygrain/frame.h"

#include "base/trigonometry.h"

namespace raygrain {

uint32_t MeshBuilder::vertex(Vec3d position) {
  mesh_.vertices.push_back(to_float(position));
  return static_cast<uint32_t>(mesh_.vertices.size() - 1);
}

// Declared one by one: the order in which arguments of a call are evaluated is the compiler's.
void MeshBuilder::triangle(Vec3d a, Vec3d b, Vec3d c) {
  const uint32_t first = vertex(a), second = vertex(b), third = vertex(c);
  triangle(first, second, third);
}

void MeshBuilder::quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const uint32_t first = vertex(a), second = vertex(b), third = vertex(c), fourth = vertex(d);
  quad(first, second, third, fourth);
}

void MeshBuilder::quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void MeshBuilder::block(const Block& block, unsigned faces) {
  const Vec3d lo = block.lo, hi = block.hi;
  const uint32_t a = vertex({lo.x, lo.y, lo.z}), b = vertex({hi.x, lo.y, lo.z});
  const uint32_t c = vertex({hi.x, lo.y, hi.z}), d = vertex({lo.x, lo.y, hi.z});
  const uint32_t e = vertex({lo.x, hi.y, lo.z}), f = vertex({hi.x, hi.y, lo.z});
  const uint32_t g = vertex({hi.x, hi.y, hi.z}), h = vertex({lo.x, hi.y, hi.z});
  if (faces & kSides) {
    quad(a, e, f, b);
    quad(b, f, g, c);
    quad(c, g, h, d);
    quad(d, h, e, a);
  }
  if (faces & kTop) quad(e, h, g, f);
  if (faces & kBottom) quad(a, b, c, d);
}

void MeshBuilder::gable_roof(const Block& base, double ridge_height, bool ridge_along_x) {
  const Vec3d lo = base.lo, hi = base.hi;
  const double top = hi.y + ridge_height, middle_x = (lo.x + hi.x) / 2, middle_z = (lo.z + hi.z) / 2;
  const uint32_t a = vertex({lo.x, hi.y, lo.z}), b = vertex({hi.x, hi.y, lo.z});
  const uint32_t c = vertex({hi.x, hi.y, hi.z}), d = vertex({lo.x, hi.y, hi.z});
  if (ridge_along_x) {
    const uint32_t west = vertex({lo.x, top, middle_z}), east = vertex({hi.x, top, middle_z});
    quad(a, west, east, b);
    quad(c, east, west, d);
    triangle(b, east, c);
    triangle(d, west, a);
  } else {
    const uint32_t north = vertex({middle_x, top, lo.z}), south = vertex({middle_x, top, hi.z});
    quad(b, north, south, c);
    quad(d, south, north, a);
    triangle(a, north, b);
    triangle(c, south, d);
  }
}

void MeshBuilder::column(const Column& column) {
  const Vec3d top = column.base + Vec3d{0, column.height, 0};
  const auto first = static_cast<uint32_t>(mesh_.vertices.size());
  limb(column.base, top, column.bottom_radius, column.top_radius, column.sides);
  if (column.top_radius <= 0) return;
  const auto sides = static_cast<uint32_t>(column.sides);
  const uint32_t middle = vertex(top);
  for (uint32_t i = 0; i < sides; ++i) triangle(middle, first + 2 * i + 1, first + 2 * ((i + 1) % sides) + 1);
}

void MeshBuilder::limb(Vec3d from, Vec3d to, double from_radius, double to_radius, int sides) {
  const Frame frame = make_frame(from, to - from, {0, 0, 1});
  const auto count = static_cast<uint32_t>(sides);
  const auto first = static_cast<uint32_t>(mesh_.vertices.size());
  for (int i = 0; i < sides; ++i) {
    const SineCosine angle = sine_cosine(2 * kPi * i / sides);
    const Vec3d outward = frame.right * angle.cosine + frame.up * angle.sine;
    vertex(from + outward * from_radius);
    if (to_radius > 0) vertex(to + outward * to_radius);
  }
  if (to_radius > 0) {
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t here = first + 2 * i, next = first + 2 * ((i + 1) % count);
      quad(here, next, next + 1, here + 1);
    }
  } else {
    const uint32_t tip = vertex(to);
    for (uint32_t i = 0; i < count; ++i) triangle(first + i, first + (i + 1) % count, tip);
  }
}

}  // namespace raygrain
