#include <algorithm>
#include <vector>

#include "base/random.h"
#include "io/mesh_builder.h"
#include "io/procedural.h"
#include "io/procedural_buildings.h"
#include "io/value_noise.h"

namespace raygrain {
namespace {

constexpr double kStreet = 12, kAvenue = 22, kKerb = 0.15;  // metres

struct Interval {
  double lo, hi;
};

// One side of a block and how many buildings stand along it.
struct Frontage {
  Interval extent;
  uint32_t lots;
};

// Blocks of two lots (the last of one where `size` is odd) along one axis, centred on 0; every fourth street is an
// avenue.
std::vector<Frontage> make_frontages(Random& random, uint32_t size) {
  std::vector<Frontage> blocks;
  double at = 0;
  for (uint32_t lot = 0; lot < size; lot += 2) {
    at += lot % 8 == 0 ? kAvenue : kStreet;
    const uint32_t lots = std::min(2u, size - lot);
    const double width = lots * random.uniform(23, 31);
    blocks.push_back({{at, at + width}, lots});
    at += width;
  }
  const double half = (at + kStreet) / 2;
  for (Frontage& block : blocks) block.extent = {block.extent.lo - half, block.extent.hi - half};
  return blocks;
}

void add_tree(MeshBuilder& builder, Random& random, Vec3d foot) {
  const double height = random.uniform(4, 9);
  builder.column({foot, 0.22, 0.15, height * 0.35, 5});
  for (int i = 0; i < 3; ++i) {
    const Vec3d base = foot + Vec3d{0, height * (0.22 + 0.22 * i), 0};
    builder.column({base, height * (0.26 - 0.06 * i), 0, height * 0.38, 7});
  }
}

void add_park(MeshBuilder& builder, Random& random, const Lot& lawn) {
  const auto trees = static_cast<int>(18 + random.below(18));
  for (int i = 0; i < trees; ++i) {
    const double x = random.uniform(lawn.lo.x, lawn.hi.x), z = random.uniform(lawn.lo.z, lawn.hi.z);
    add_tree(builder, random, {x, lawn.lo.y, z});
  }
}

// `heading_x`: the car stands along x.
void add_car(MeshBuilder& builder, Vec3d foot, bool heading_x) {
  const auto box = [&](Interval along, double half_width, Interval up) {
    const Vec3d lo = heading_x ? Vec3d{along.lo, up.lo, -half_width} : Vec3d{-half_width, up.lo, along.lo};
    const Vec3d hi = heading_x ? Vec3d{along.hi, up.hi, half_width} : Vec3d{half_width, up.hi, along.hi};
    builder.block({foot + lo, foot + hi}, kAllFaces);
  };
  box({-2.1, 2.1}, 0.9, {0.3, 0.85});
  box({-1.3, 0.9}, 0.8, {0.85, 1.45});
}

void add_lamp(MeshBuilder& builder, Vec3d foot, Vec3d towards_street) {
  const Vec3d top = foot + Vec3d{0, 6, 0};
  builder.limb(foot, top, 0.1, 0.06, 5);
  const Vec3d lamp = top + towards_street * 1.6;
  builder.limb(top, lamp, 0.05, 0.05, 4);
  builder.block({lamp - Vec3d{0.25, 0.1, 0.25}, lamp + Vec3d{0.25, 0.05, 0.25}}, kAllFaces);
}

// Where cars may be parked along an edge. Sums, not products: their rounding is part of what a seed makes.
std::vector<double> parking_places(double lo, double hi) {
  std::vector<double> places;
  double place = lo + 4;
  while (place < hi - 4) {
    places.push_back(place);
    place += 6;
  }
  return places;
}

// Cars parked along, and lamps standing at, two of the block's edges.
void add_street_furniture(MeshBuilder& builder, Random& random, const Block& block) {
  for (const double x : parking_places(block.lo.x, block.hi.x))
    if (random.below(5) < 2) add_car(builder, {x, 0, block.lo.z - 1.4}, true);
  for (const double z : parking_places(block.lo.z, block.hi.z))
    if (random.below(5) < 2) add_car(builder, {block.lo.x - 1.4, 0, z}, false);
  const double middle_x = (block.lo.x + block.hi.x) / 2, middle_z = (block.lo.z + block.hi.z) / 2;
  add_lamp(builder, {middle_x, kKerb, block.lo.z + 0.6}, {0, 0, -1});
  add_lamp(builder, {block.lo.x + 0.6, kKerb, middle_z}, {-1, 0, 0});
}

// `density` in [0, 1] says what is built: houses, apartments or towers.
void add_building(MeshBuilder& builder, Random& random, const Lot& lot, double density) {
  const double kind = density + random.uniform(-0.12, 0.12);
  if (kind < 0.38) return add_house(builder, random, lot);
  if (kind < 0.62) return add_apartments(builder, random, lot, static_cast<int>(3 + random.below(6)));
  const int storeys = static_cast<int>(8 + density * 22 + static_cast<double>(random.below(9)));
  if (random.below(4) == 0) return add_round_tower(builder, random, lot, storeys);
  add_stepped_tower(builder, random, lot, storeys);
}

void add_lots(MeshBuilder& builder, Random& random, const Frontage& along_x, const Frontage& along_z, double density) {
  const double pavement = 3.5;
  const double width = (along_x.extent.hi - along_x.extent.lo - 2 * pavement) / along_x.lots;
  const double depth = (along_z.extent.hi - along_z.extent.lo - 2 * pavement) / along_z.lots;
  for (uint32_t row = 0; row < along_z.lots; ++row)
    for (uint32_t column = 0; column < along_x.lots; ++column) {
      const Vec3d lo{along_x.extent.lo + pavement + column * width, kKerb, along_z.extent.lo + pavement + row * depth};
      add_building(builder, random, {lo, lo + Vec3d{width, 0, depth}}, density);
    }
}

// High in the middle and where the noise is, low at the rim.
double density_at(const Block& block, double half_side, uint64_t seed) {
  const double x = (block.lo.x + block.hi.x) / 2, z = (block.lo.z + block.hi.z) / 2;
  const double from_middle = std::max(std::abs(x), std::abs(z)) / half_side;
  return std::clamp(0.75 * (1 - from_middle) + 0.7 * (fractal_noise(x / 150, z / 150, 2, seed) - 0.15), 0.0, 1.0);
}

}  // namespace

TriangleMesh make_city(uint32_t size, uint64_t seed) {
  MeshBuilder builder;
  Random layout(seed);
  const std::vector<Frontage> columns = make_frontages(layout, size), rows = make_frontages(layout, size);
  const double east = columns.back().extent.hi + kStreet, south = rows.back().extent.hi + kStreet;
  const double west = columns.front().extent.lo - kAvenue, north = rows.front().extent.lo - kAvenue;
  builder.quad(Vec3d{west, 0, north}, Vec3d{west, 0, south}, Vec3d{east, 0, south}, Vec3d{east, 0, north});
  for (const Frontage& row : rows)
    for (const Frontage& column : columns) {
      Random random(layout.next());
      const Block block{{column.extent.lo, 0, row.extent.lo}, {column.extent.hi, kKerb, row.extent.hi}};
      builder.block(block, kSidesAndTop);
      add_street_furniture(builder, random, block);
      if (random.below(9) == 0)
        add_park(builder, random, {block.lo + Vec3d{3, kKerb, 3}, block.hi - Vec3d{3, 0, 3}});
      else
        add_lots(builder, random, column, row, density_at(block, std::max(east, south), seed));
    }
  return builder.take();
}

}  // namespace raygrain
