// The houses, apartment blocks and towers of the procedural city.
#pragma once

#include "base/random.h"
#include "io/mesh_builder.h"

namespace raygrain {

/// A piece of ground that a building may fill: x and z extent, its level in y (lo.y; hi.y is not used).
using Lot = Block;

void add_house(MeshBuilder& builder, Random& random, const Lot& lot);
void add_apartments(MeshBuilder& builder, Random& random, const Lot& lot, int storeys);
void add_stepped_tower(MeshBuilder& builder, Random& random, const Lot& lot, int storeys);
void add_round_tower(MeshBuilder& builder, Random& random, const Lot& lot, int storeys);

}  // namespace raygrain
