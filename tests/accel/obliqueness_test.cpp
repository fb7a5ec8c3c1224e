// Scene and rays turned together: ray space does not notice.
#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/coverage.h"
#include "raygrain/frame_tree.h"
#include "raygrain/rays.h"
#include "raygrain/wide.h"

#include "accel/build_trees.h"
#include "base/random.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

using test::same_bits;

/// A floor of boxes with axis-parallel faces.
TriangleMesh town(uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) {
      const auto x = static_cast<float>(i), z = static_cast<float>(k);
      quad({x, 0, z}, {x + 1, 0, z}, {x + 1, 0, z + 1}, {x, 0, z + 1});
      const Bounds b{{x + 0.2f, 0, z + 0.2f},
                     {x + static_cast<float>(random.uniform(0.4, 0.9)), static_cast<float>(random.uniform(0.3, 3)),
                      z + static_cast<float>(random.uniform(0.4, 0.9))}};
      quad(corner(b, 2), corner(b, 3), corner(b, 7), corner(b, 6));
      quad(corner(b, 0), corner(b, 1), corner(b, 3), corner(b, 2));
      quad(corner(b, 4), corner(b, 5), corner(b, 7), corner(b, 6));
      quad(corner(b, 0), corner(b, 4), corner(b, 6), corner(b, 2));
      quad(corner(b, 1), corner(b, 5), corner(b, 7), corner(b, 3));
    }
  return mesh;
}

double pruned_cost(const TraceCounters& c) {
  return 2 * static_cast<double>(c.inner_hits) + 1.2 * static_cast<double>(c.leaf_triangles);
}

const Vec3d kSun = normalized(Vec3d{0.3, -1, 0.45});

/// Some way to turn the world, the first being none.
Frame turn_of(int number, Random& random) {
  if (number == 0) return {};
  const Vec3d forward{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  return make_frame({}, forward, {random.uniform(-1, 1), 0.3, 1});
}

Vec3 turned(const Frame& axes, Vec3d v) {
  return to_float(to_world_direction(axes, v));
}

TriangleMesh turned(const Frame& axes, TriangleMesh mesh) {
  for (Vec3& vertex : mesh.vertices) vertex = turned(axes, to_double(vertex));
  return mesh;
}

InfluenceArea sun_over(const Frame& axes, const TriangleMesh& mesh) {
  InfluenceArea area = directional_light_area("sun", turned(axes, kSun), mesh_bounds(mesh));
  std::get<PlaneArea>(area.shape).up = turned(axes, {0, 0, 1});
  return area;
}

double spread(const std::vector<double>& costs) {
  const auto [least, most] = std::ranges::minmax(costs);
  return most / least;
}

// Scene and rays turned together: the rotated frame does not notice, the world's axes do. Of the frames that are chosen
// as users have it, shears follow the world's axes, so these cost as they come.
TEST(FrameTree, ObliquenessCostsNothing) {
  const TriangleMesh scene = town(5);
  std::vector<Vec3d> starts;
  Random random(9);
  for (int i = 0; i < 2000; ++i) starts.push_back({random.uniform(0, 20), 3.5, random.uniform(0, 20)});
  std::vector<double> rotated, chosen, in_world;
  std::vector<FrameKind> kinds;
  const int choices = std::min(20, static_cast<int>(test::seed_count(5)));  // they take most of the time
  for (int turn = 0; turn < 20; ++turn) {
    const Frame axes = turn_of(turn, random);
    const TriangleMesh mesh = turned(axes, scene);
    const InfluenceArea sun = sun_over(axes, mesh);
    const AreaGeometry geometry(sun);
    RayFrame frame = *area_frame(FrameKind::kRotation, geometry);
    frame.domain = {{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}};
    std::vector<uint32_t> ids(mesh.triangle_count());
    std::iota(ids.begin(), ids.end(), 0u);
    const auto corners = std::make_shared<const TriangleCorners>(mesh);
    const auto tree = build_frame_tree(frame, corners, ids);
    const WideBvh wide(build_binned(triangle_bounds(mesh), triangle_centroids(mesh), {}), mesh);
    std::optional<FrameTree> users;
    if (turn < choices) users = build_area_frame_tree(sun, corners, ids, {}, {});
    TraceCounters ours, theirs, worlds;
    for (const Vec3d start : starts) {
      const Ray ray{turned(axes, start), turned(axes, kSun)};
      const Hit hit = wide.intersect_counted(ray, worlds);
      ASSERT_TRUE(same_bits(*tree->intersect_counted(ray, ours), hit));
      if (users) {
        ASSERT_TRUE(same_bits(*users->intersect_counted(ray, theirs), hit));
      }
    }
    rotated.push_back(pruned_cost(ours));
    if (users) chosen.push_back(pruned_cost(theirs)), kinds.push_back(users->frame().kind);
    in_world.push_back(pruned_cost(worlds));
  }
  std::cout << "turned 20 times: pruned cost varies by a factor of " << spread(rotated) << " in the rotated frame, "
            << spread(in_world) << " in the world's axes; of the first " << choices << " in the chosen frame by "
            << spread(chosen) << ", relative to the rotated one:";
  for (size_t i = 0; i < kinds.size(); ++i) std::cout << ' ' << name(kinds[i]) << ' ' << chosen[i] / rotated[i];
  std::cout << '\n';
  EXPECT_LE(spread(rotated), 1.05);
  EXPECT_LE(spread(chosen), 1.25);
  EXPECT_GE(spread(in_world), 1.1);
}

struct CellCosts {
  double tests, told;  // triangles tested, and rays that cells alone answer
};

/// Of rays towards a sun, all of which the coverage must answer.
CellCosts cell_costs(const TriangleMesh& mesh, const InfluenceArea& sun, const std::vector<Vec3>& points) {
  const Coverage coverage(std::make_shared<const TriangleMesh>(mesh), sun);
  std::vector<uint8_t> flags(points.size());
  std::vector<uint32_t> rest;
  CoverageCounters counters;
  coverage.occluded(points, -std::get<PlaneArea>(sun.shape).direction, flags, rest, {}, 1, &counters);
  EXPECT_TRUE(rest.empty());
  return {static_cast<double>(counters.triangle_tests), static_cast<double>(counters.covered + counters.free)};
}

// Nor do cells. Turning the sun alone costs more.
TEST(Coverage, ObliquenessCostsNothing) {
  const TriangleMesh scene = town(5);
  std::vector<Vec3d> starts;
  Random random(9);
  for (int i = 0; i < 20000; ++i)
    starts.push_back({random.uniform(0, 20), random.uniform(0, 3), random.uniform(0, 20)});
  std::vector<double> tests, told, of_other_suns;
  for (int turn = 0; turn < 20; ++turn) {
    SCOPED_TRACE("turn " + std::to_string(turn));
    const Frame axes = turn_of(turn, random);
    const TriangleMesh mesh = turned(axes, scene);
    std::vector<Vec3> points, unturned;
    for (const Vec3d start : starts) points.push_back(turned(axes, start)), unturned.push_back(to_float(start));
    const CellCosts costs = cell_costs(mesh, sun_over(axes, mesh), points);
    tests.push_back(costs.tests), told.push_back(costs.told);
    Vec3 other = turned(axes, kSun);
    other.y = -std::abs(other.y) - 0.2f;
    const InfluenceArea other_sun = directional_light_area("sun", other, mesh_bounds(scene));
    of_other_suns.push_back(cell_costs(scene, other_sun, unturned).tests);
  }
  std::cout << "turned 20 times: triangles tested vary by a factor of " << spread(tests) << ", rays told by cells by "
            << spread(told) << "; under 20 suns tests vary by " << spread(of_other_suns) << '\n';
  EXPECT_LE(spread(tests), 1.05);
  EXPECT_LE(spread(told), 1.05);
  EXPECT_GE(spread(of_other_suns), 1.1);
}

}  // namespace
}  // namespace raygrain
