#include "raygrain/top_level.h"

#include <algorithm>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "base/random.h"

namespace raygrain {
namespace {

Vec3 random_point(Random& random, double half_size) {
  const double x = random.uniform(-half_size, half_size), y = random.uniform(-half_size, half_size);
  return to_float({x, y, random.uniform(-half_size, half_size)});
}

Frame random_frame(Random& random) {
  const Vec3d origin = to_double(random_point(random, 8));
  const Vec3d forward = to_double(random_point(random, 1)) + Vec3d{0, 0, 1e-3};
  return make_frame(origin, forward, to_double(random_point(random, 1)));
}

/// Boxes, oriented boxes and frusta (some with corners of a few degrees) in about [-16, 16]^3.
std::vector<ConvexRegion> random_regions(size_t count, Random& random) {
  std::vector<ConvexRegion> regions;
  for (size_t i = 0; i < count; ++i) {
    Bounds box;
    box.extend(random_point(random, 8));
    box.extend(random_point(random, 8));
    const Frame frame = random_frame(random);
    const double near_z = random.uniform(0.01, 1), tangent = random.below(3) == 0 ? 50 : random.uniform(0.1, 2);
    switch (random.below(3)) {
      case 0:
        regions.push_back(box_region(box));
        break;
      case 1:
        regions.push_back(oriented_box_region(frame, random.uniform(0.1, 4), random.uniform(0.1, 4), 5));
        break;
      default:
        regions.push_back(frustum_region(frame, tangent, random.uniform(0.1, 2), near_z, near_z + 6));
        break;
    }
  }
  return regions;
}

/// A point between corners of a region, often on a face, an edge or a corner, moved out by up to twice the slack.
Vec3 border_point(const ConvexRegion& region, Random& random) {
  Vec3d weights{random.uniform(), random.uniform(), random.uniform()};
  for (int axis = 0; axis < 3; ++axis)
    if (random.below(2)) weights[axis] = static_cast<double>(random.below(2));
  Vec3d point{};
  for (size_t i = 0; i < 8; ++i) {
    const double weight = ((i & 1) ? weights.x : 1 - weights.x) * ((i & 2) ? weights.y : 1 - weights.y) *
                          ((i & 4) ? weights.z : 1 - weights.z);
    const double outward = random.uniform(0, 1);
    point = point + (region.corners[i] * (1 - outward) + region.outer_corners[i] * outward) * weight;
  }
  return to_float(point);
}

/// Corners, edge and face points of a cell.
Vec3 cell_point(const Bounds& cell, Random& random) {
  Vec3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const float choices[] = {cell.lo[axis], cell.hi[axis], center(cell)[axis]};
    point[axis] = choices[random.below(3)];
    if (random.below(4) == 0) point[axis] = std::nextafter(point[axis], random.below(2) ? kInf : -kInf);
  }
  return point;
}

std::vector<uint32_t> containing(std::span<const ConvexRegion> regions, std::span<const uint32_t> listed, Vec3 point) {
  std::vector<uint32_t> result;
  for (const uint32_t i : listed)
    if (contains(regions[i], point)) result.push_back(i);
  return result;
}

std::vector<Vec3> query_points(std::span<const ConvexRegion> regions, const TopLevel& octree, size_t count,
                               Random& random) {
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) {
    points.push_back(random_point(random, 20));
    if (!regions.empty()) points.push_back(border_point(regions[random.below(regions.size())], random));
    if (!octree.nodes().empty())
      points.push_back(cell_point(octree.nodes()[random.below(octree.nodes().size())].bounds, random));
  }
  return points;
}

TEST(TopLevel, OctreeAndListFindTheSameRegions) {
  for (const uint32_t level : {0u, 1u, 2u, 4u, 5u, 6u})
    for (const size_t count : {0u, 1u, 2u, 7u, 64u}) {
      if (level > 5 && count > 7) continue;
      SCOPED_TRACE("level " + std::to_string(level) + ", regions " + std::to_string(count));
      Random random(level * 100 + count);
      const std::vector<ConvexRegion> regions = random_regions(count, random);
      const TopLevel list(regions, {TopLevelKind::kList}), octree(regions, {TopLevelKind::kOctree, level});
      size_t found = 0;
      for (const Vec3 p : query_points(regions, octree, 2000, random)) {
        const auto listed = octree.regions_at(p);
        ASSERT_TRUE(std::ranges::is_sorted(listed));
        ASSERT_EQ(containing(regions, listed, p), containing(regions, list.regions_at(p), p));
        found += containing(regions, listed, p).size();
      }
      EXPECT_EQ(found > 0, count > 0);
    }
}

TEST(TopLevel, DeepTreesOfSmallRegionsAgree) {
  for (const uint32_t level : {8u, 10u}) {
    SCOPED_TRACE(level);
    Random random(level);
    std::vector<ConvexRegion> regions{
        box_region({{-10, -10, -10}, {-9.99f, -9.99f, -9.99f}}), box_region({{9, 9, 9}, {9.02f, 9.02f, 9.02f}}),
        frustum_region(make_frame({0, 0, 0}, {1, 2, 3}, {0, 1, 0}), 0.01, 0.01, 0.1, 0.3)};
    const TopLevel list(regions, {TopLevelKind::kList}), octree(regions, {TopLevelKind::kOctree, level});
    for (const Vec3 p : query_points(regions, octree, 5000, random))
      ASSERT_EQ(containing(regions, octree.regions_at(p), p), containing(regions, list.regions_at(p), p));
  }
}

TEST(TopLevel, OctreeCellsPartitionTheirParent) {
  Random random(3);
  const std::vector<ConvexRegion> regions = random_regions(12, random);
  const TopLevel octree(regions, {TopLevelKind::kOctree, 4});
  size_t reached = 1;
  for (const TopLevel::Node& node : octree.nodes()) {
    if (node.first_child == 0) continue;
    reached += 8;
    Bounds all;
    double volume = 0;
    for (uint32_t i = 0; i < 8; ++i) {
      const Bounds child = octree.nodes()[node.first_child + i].bounds;
      all.extend(child);
      const Vec3d size = to_double(child.hi) - to_double(child.lo);
      volume += size.x * size.y * size.z;
    }
    const Vec3d size = to_double(node.bounds.hi) - to_double(node.bounds.lo);
    EXPECT_EQ(all, node.bounds);
    EXPECT_NEAR(volume, size.x * size.y * size.z, 1e-9 * volume);
  }
  EXPECT_EQ(reached, octree.nodes().size());
}

TEST(TopLevel, StopsWhereHomogeneous) {
  // One box that fills its own root: every point of the root is inside, so the root needs no children.
  const std::vector<ConvexRegion> box{box_region({{0, 0, 0}, {1, 1, 1}})};
  const TopLevel octree(box, {TopLevelKind::kOctree, 3});
  // The root is the box with its slack, which the region does not enclose: only cells on the border are split.
  for (const TopLevel::Node& node : octree.nodes())
    if (encloses(box[0], node.bounds)) {
      EXPECT_EQ(node.first_child, 0u);
    }
  EXPECT_LT(octree.nodes().size(), 1u + 8 + 64 + 512);

  // Two boxes far apart: empty space between them is one leaf per cell, never split further.
  const std::vector<ConvexRegion> two{box_region({{0, 0, 0}, {1, 1, 1}}), box_region({{15, 15, 15}, {16, 16, 16}})};
  const TopLevel sparse(two, {TopLevelKind::kOctree, 5});
  for (const TopLevel::Node& node : sparse.nodes()) {
    const bool touched = overlaps(two[0], node.bounds) || overlaps(two[1], node.bounds);
    if (!touched) {
      EXPECT_EQ(node.first_child, 0u);
      EXPECT_EQ(node.regions, 0u);
    }
  }
}

TEST(TopLevel, OctreeIsSharperThanTheList) {
  Random random(5);
  const std::vector<ConvexRegion> regions = random_regions(64, random);
  const TopLevel list(regions, {TopLevelKind::kList});
  size_t previous = std::numeric_limits<size_t>::max();
  for (const uint32_t level : {0u, 2u, 5u}) {
    const TopLevel octree(regions, {TopLevelKind::kOctree, level});
    size_t listed = 0;
    Random points(6);
    for (int i = 0; i < 3000; ++i) listed += octree.regions_at(random_point(points, 10)).size();
    EXPECT_LT(listed, previous) << level;
    previous = listed;
  }
  EXPECT_LT(previous, 3000 * list.regions_at({}).size());
}

TEST(TopLevel, EqualListsAreSharedAndMemoryIsCounted) {
  const std::vector<ConvexRegion> regions(3, box_region({{0, 0, 0}, {1, 1, 1}}));
  const TopLevel octree(regions, {TopLevelKind::kOctree, 4});
  // Every leaf lists all three or none.
  for (const TopLevel::Node& node : octree.nodes()) EXPECT_TRUE(node.regions == 0 || node.first_region == 0);
  EXPECT_GE(octree.memory_bytes(), octree.nodes().size() * sizeof(TopLevel::Node));
  EXPECT_LT(octree.memory_bytes(), octree.nodes().size() * sizeof(TopLevel::Node) * 2 + 1000);
}

TEST(TopLevel, PointsThatAreNoPointsAreInNoCell) {
  const std::vector<ConvexRegion> regions{box_region({{0, 0, 0}, {1, 1, 1}})};
  const TopLevel octree(regions, {TopLevelKind::kOctree, 5});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, kInf, -kInf})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p{0.5f, 0.5f, 0.5f};
      ASSERT_EQ(octree.regions_at(p).size(), 1u);
      p[axis] = bad;
      EXPECT_TRUE(octree.regions_at(p).empty());
    }
  EXPECT_TRUE(octree.regions_at({3, 0, 0}).empty());
  EXPECT_TRUE(TopLevel().regions_at({0, 0, 0}).empty());
  EXPECT_TRUE(TopLevel({}, {TopLevelKind::kOctree, 5}).regions_at({0, 0, 0}).empty());
}

TEST(TopLevel, ExtremeScalesAgree) {
  for (const double scale : {1e-41, 1e-20, 1.0, 1e20, 1e37}) {
    SCOPED_TRACE(scale);
    Random random(11);
    std::vector<ConvexRegion> regions;
    for (int i = 0; i < 5; ++i) {
      const Frame frame = random_frame(random);
      Frame scaled = frame;
      scaled.origin = frame.origin * (scale / 10);
      regions.push_back(oriented_box_region(scaled, scale * 0.3, scale * 0.2, scale));
      regions.push_back(frustum_region(scaled, 1, 0.5, scale * 0.01, scale));
    }
    const TopLevel list(regions, {TopLevelKind::kList}), octree(regions, {TopLevelKind::kOctree, 5});
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = border_point(regions[random.below(regions.size())], random);
      ASSERT_EQ(containing(regions, octree.regions_at(p), p), containing(regions, list.regions_at(p), p));
    }
  }
}

TEST(TopLevel, RefusesLevelsBeyondTheLimit) {
  try {
    TopLevel({}, {TopLevelKind::kOctree, 11});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    EXPECT_EQ(error.where, "top_level.max_level");
  }
}

}  // namespace
}  // namespace raygrain
