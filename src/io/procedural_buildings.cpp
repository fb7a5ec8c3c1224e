#include "io/procedural_buildings.h"

#include <algorithm>

namespace raygrain {
namespace {

constexpr double kStorey = 3.2;  // metres

Block inset(Block block, double by) {
  block.lo.x += by, block.lo.z += by;
  block.hi.x -= by, block.hi.z -= by;
  return block;
}

Block with_height(Block block, double bottom, double top) {
  block.lo.y = bottom;
  block.hi.y = top;
  return block;
}

// A slab on the wall of `body`: `along` in [0, 1] is its middle along wall `side` (0 -z, 1 +x, 2 +z, 3 -x).
Block wall_slab(const Block& body, int side, double along, Vec3d size_along_up_out, double bottom) {
  const Vec3d size = size_along_up_out;
  const bool along_x = side == 0 || side == 2, positive = side == 1 || side == 2;
  const double lo = along_x ? body.lo.x : body.lo.z, hi = along_x ? body.hi.x : body.hi.z;
  const double middle = lo + (hi - lo) * along;
  const double wall = along_x ? (positive ? body.hi.z : body.lo.z) : (positive ? body.hi.x : body.lo.x);
  const double inner = positive ? wall : wall - size.z, outer = positive ? wall + size.z : wall;
  const double from = middle - size.x / 2, to = middle + size.x / 2;
  if (along_x) return {{from, bottom, inner}, {to, bottom + size.y, outer}};
  return {{inner, bottom, from}, {outer, bottom + size.y, to}};
}

void add_window_row(MeshBuilder& builder, const Block& body, int side, int count, double bottom) {
  for (int i = 0; i < count; ++i)
    builder.block(wall_slab(body, side, (i + 0.5) / count, {1.1, 1.4, 0.08}, bottom), kAllFaces);
}

// A ledge around the body: wider than it by `out`.
void add_ledge(MeshBuilder& builder, const Block& body, double bottom, double thickness, double out) {
  builder.block(with_height(inset(body, -out), bottom, bottom + thickness), kAllFaces);
}

void add_parapet(MeshBuilder& builder, const Block& body) {
  const double y = body.hi.y, width = 0.3, top = y + 0.9;
  const Vec3d lo = body.lo, hi = body.hi;
  builder.block({{lo.x, y, lo.z}, {hi.x, top, lo.z + width}}, kSidesAndTop);
  builder.block({{lo.x, y, hi.z - width}, {hi.x, top, hi.z}}, kSidesAndTop);
  builder.block({{lo.x, y, lo.z + width}, {lo.x + width, top, hi.z - width}}, kSidesAndTop);
  builder.block({{hi.x - width, y, lo.z + width}, {hi.x, top, hi.z - width}}, kSidesAndTop);
}

Vec3d point_on_roof(Random& random, const Block& body, double margin) {
  const double x = random.uniform(body.lo.x + margin, body.hi.x - margin);
  const double z = random.uniform(body.lo.z + margin, body.hi.z - margin);
  return {x, body.hi.y, z};
}

void add_water_tank(MeshBuilder& builder, Vec3d foot) {
  for (const double dx : {-0.8, 0.8})
    for (const double dz : {-0.8, 0.8})
      builder.block({foot + Vec3d{dx - 0.1, 0, dz - 0.1}, foot + Vec3d{dx + 0.1, 1.6, dz + 0.1}}, kSides);
  builder.column({foot + Vec3d{0, 1.6, 0}, 1.4, 1.4, 2.4, 10});
  builder.column({foot + Vec3d{0, 4.0, 0}, 1.6, 0, 1.0, 10});
}

void add_roof_furniture(MeshBuilder& builder, Random& random, const Block& body) {
  const auto boxes = static_cast<int>(2 + random.below(4));
  for (int i = 0; i < boxes; ++i) {
    const Vec3d foot = point_on_roof(random, body, 2.5);
    const double width = random.uniform(0.6, 1.6), depth = random.uniform(0.6, 1.6);
    builder.block({foot - Vec3d{width, 0, depth}, foot + Vec3d{width, random.uniform(0.8, 2.2), depth}}, kSidesAndTop);
  }
  if (random.below(3) == 0) add_water_tank(builder, point_on_roof(random, body, 2.5));
}

void add_antenna(MeshBuilder& builder, Vec3d foot, double height) {
  builder.column({foot, 0.25, 0.06, height, 5});
  for (const double share : {0.5, 0.7, 0.85}) {
    const Vec3d arm = foot + Vec3d{0, height * share, 0};
    builder.block({arm - Vec3d{1.2 * (1 - share) + 0.3, 0.04, 0.04}, arm + Vec3d{1.2 * (1 - share) + 0.3, 0.04, 0.04}},
                  kAllFaces);
  }
}

void add_balconies(MeshBuilder& builder, const Block& body, int side, int storeys) {
  for (int storey = 1; storey < storeys; ++storey)
    for (const double along : {0.28, 0.72}) {
      const double floor = body.lo.y + storey * kStorey;
      const Block slab = wall_slab(body, side, along, {3.0, 0.15, 1.3}, floor);
      builder.block(slab, kAllFaces);
      builder.block(with_height(slab, floor + 0.95, floor + 1.05), kAllFaces);  // the rail
    }
}

}  // namespace

void add_house(MeshBuilder& builder, Random& random, const Lot& lot) {
  const auto storeys = static_cast<int>(1 + random.below(2));
  const double floor = lot.lo.y, top = floor + storeys * 2.9 + 0.3;
  const Block body = with_height(inset(lot, random.uniform(1.5, 3.5)), floor, top);
  builder.block(body, kSides);
  const bool ridge_along_x = body.hi.x - body.lo.x > body.hi.z - body.lo.z;
  const double span = ridge_along_x ? body.hi.z - body.lo.z : body.hi.x - body.lo.x;
  builder.gable_roof(inset(body, -0.6), span * random.uniform(0.28, 0.5), ridge_along_x);
  for (int storey = 0; storey < storeys; ++storey)
    for (int side = 0; side < 4; ++side) add_window_row(builder, body, side, 2, floor + 1.0 + storey * 2.9);
  builder.block(wall_slab(body, static_cast<int>(random.below(4)), 0.5, {1.2, 2.2, 0.12}, floor), kSidesAndTop);
  const Vec3d chimney{body.lo.x + (body.hi.x - body.lo.x) * random.uniform(0.2, 0.4), top,
                      body.lo.z + (body.hi.z - body.lo.z) * random.uniform(0.3, 0.7)};
  builder.block({chimney - Vec3d{0.4, 0, 0.4}, chimney + Vec3d{0.4, span * 0.5 + 0.8, 0.4}}, kSidesAndTop);
}

void add_apartments(MeshBuilder& builder, Random& random, const Lot& lot, int storeys) {
  const double floor = lot.lo.y;
  const Block body = with_height(inset(lot, random.uniform(0.4, 1.6)), floor, floor + storeys * kStorey + 0.6);
  builder.block(body, kSidesAndTop);
  add_parapet(builder, body);
  add_ledge(builder, body, floor + kStorey, 0.25, 0.3);
  add_ledge(builder, body, body.hi.y - 0.5, 0.3, 0.35);
  const auto balcony_side = static_cast<int>(random.below(4));
  add_balconies(builder, body, balcony_side, storeys);
  const int window_side = (balcony_side + 2) % 4;
  const int first = std::max(1, storeys - 3);
  for (int storey = first; storey < storeys; ++storey)
    add_window_row(builder, body, window_side, 3, floor + storey * kStorey + 0.9);
  add_roof_furniture(builder, random, body);
}

void add_stepped_tower(MeshBuilder& builder, Random& random, const Lot& lot, int storeys) {
  Block tier = inset(lot, random.uniform(0.5, 2));
  const auto tiers = static_cast<int>(2 + random.below(3));
  double bottom = lot.lo.y, rest = storeys * kStorey;
  for (int i = 0; i < tiers; ++i) {
    const double height = i + 1 == tiers ? rest : rest * random.uniform(0.4, 0.6);
    tier = with_height(tier, bottom, bottom + height);
    builder.block(tier, kSidesAndTop);
    const int pilasters = i == 0 ? 5 : 3;
    for (int side = 0; side < 4; ++side)
      for (int k = 0; k < pilasters; ++k)
        builder.block(wall_slab(tier, side, (k + 0.5) / pilasters, {0.6, height, 0.35}, bottom), kSidesAndTop);
    add_ledge(builder, tier, tier.hi.y - 0.7, 0.7, 0.6);
    bottom += height;
    rest -= height;
    if (i + 1 < tiers) tier = inset(tier, 0.14 * std::min(tier.hi.x - tier.lo.x, tier.hi.z - tier.lo.z));
  }
  const Vec3d summit{(tier.lo.x + tier.hi.x) / 2, bottom, (tier.lo.z + tier.hi.z) / 2};
  add_antenna(builder, summit, random.uniform(8, 22));
}

void add_round_tower(MeshBuilder& builder, Random& random, const Lot& lot, int storeys) {
  const Vec3d foot{(lot.lo.x + lot.hi.x) / 2, lot.lo.y, (lot.lo.z + lot.hi.z) / 2};
  const double radius = std::min(lot.hi.x - lot.lo.x, lot.hi.z - lot.lo.z) * random.uniform(0.36, 0.46);
  const double height = storeys * kStorey;
  builder.column({foot, radius, radius * 0.94, height, 20});
  for (int storey = 3; storey < storeys; storey += 3)
    builder.column({foot + Vec3d{0, storey * kStorey, 0}, radius + 0.5, radius + 0.5, 0.4, 20});
  builder.column({foot + Vec3d{0, height, 0}, radius * 0.6, radius * 0.2, radius * 0.8, 16});
  add_antenna(builder, foot + Vec3d{0, height + radius * 0.8, 0}, random.uniform(5, 12));
}

}  // namespace raygrain
