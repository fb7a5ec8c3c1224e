// Tests of triangles against cells: sure where they say so, and in one piece along a line of cells.
#include "trace/coverage_squares.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "trace/coverage_window.h"

namespace raygrain {
namespace {

constexpr uint32_t kAcross = 12;

// Small, large, and thin ones; some are lines to the light.
CoverageGrid grid_of_triangles(size_t count, bool is_eye) {
  Random random(7);
  TriangleMesh mesh;
  const auto within = [&](float size) { return static_cast<float>(random.uniform(-size, size)); };
  for (uint32_t i = 0; i < count; ++i) {
    const float size = i % 3 == 0 ? 0.1f : 1;
    const Vec3 center{within(1), within(1), within(1)};
    Vec3 p[3];
    for (Vec3& corner : p) corner = center + Vec3{within(size), within(size), within(size)};
    if (i % 5 == 0) p[2] = p[0] + 0.5f * (p[1] - p[0]) + Vec3{within(0.01f), within(0.01f), within(0.01f)};
    if (i % 7 == 0) p[1] = p[0] + Vec3{0, 0, 0.3f};
    if (i % 11 == 0) p[1].y = p[0].y;
    mesh.vertices.insert(mesh.vertices.end(), p, p + 3);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  CoverageGrid grid;
  grid.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  InfluenceArea area{"", PlaneArea{{0, 0, -4}, {0, 0, 1}, {0, 1, 0}, 2, 2, 8}};
  if (is_eye) area.shape = PointArea{{0, 0, -4}, {0, 0, 1}, {0, 1, 0}, 40, 40, 0.1f, 8};
  EXPECT_TRUE(set_window(grid, AreaGeometry(area)));
  return grid;
}

CellSquare square_at(const CoverageGrid& grid, uint32_t column, uint32_t line) {
  const double width = (static_cast<double>(grid.x_hi) - grid.x_lo) / kAcross;
  return {grid.x_lo + (column + 0.5) * width, grid.y_lo + (line + 0.5) * width, width / 2};
}

struct Place {
  double x, y, s;
};

Place place_in(const CoverageGrid& grid, uint32_t id, const std::array<double, 3>& weights) {
  Vec3d q;
  for (int i = 0; i < 3; ++i) q = q + grid.map.turned(grid.mesh->vertex(id, i)) * weights[static_cast<size_t>(i)];
  return grid.map.is_eye ? Place{q.x / q.z, q.y / q.z, 1 / q.z} : Place{q.x, q.y, q.z};
}

// How far outside the square, by the greater coordinate.
double outside(const CellSquare& square, Place p) {
  return std::max(std::abs(p.x - square.x), std::abs(p.y - square.y)) - square.half;
}

// Visits the triangles that the light sees: (id, tests).
template <class Visit>
void for_each_seen(const CoverageGrid& grid, const Visit& visit) {
  size_t seen_count = 0;
  for (uint32_t id = 0; id < grid.mesh->triangle_count(); ++id) {
    SeenTriangle seen;
    if (look_at(grid, 0.05, id, seen) != Seen::kSeen) continue;
    ++seen_count;
    visit(id, SquareTests(seen, square_at(grid, 0, 0).half), seen);
    if (testing::Test::HasFatalFailure()) return;
  }
  ASSERT_GT(seen_count, grid.mesh->triangle_count() / 2);
}

class CoverageSquares : public testing::TestWithParam<bool> {};

TEST_P(CoverageSquares, AreMetInOnePieceAlongALine) {
  const CoverageGrid grid = grid_of_triangles(2000, GetParam());
  size_t stops = 0;
  for_each_seen(grid, [&](uint32_t id, const SquareTests& tests, const SeenTriangle&) {
    for (uint32_t line = 0; line < kAcross; ++line) {
      int pieces = 0;
      bool was_met = false, any = false;
      for (uint32_t column = 0; column < kAcross; ++column) {
        const CellSquare square = square_at(grid, column, line);
        InCell one;
        const bool is_met = tests.meet(square.x, square.y, 7, one);
        pieces += is_met && !was_met;
        any |= is_met;
        was_met = is_met;
        if (tests.goes_on_at(square.x, square.y)) continue;
        ++stops;
        ASSERT_FALSE(any) << "triangle " << id << " line " << line << " column " << column;
      }
      ASSERT_LE(pieces, 1) << "triangle " << id << " line " << line;
    }
  });
  EXPECT_GT(stops, 1000u);
}

TEST_P(CoverageSquares, KnowWhatLiesInThem) {
  const CoverageGrid grid = grid_of_triangles(1000, GetParam());
  Random random(3);
  size_t filled = 0, edges = 0;
  for_each_seen(grid, [&](uint32_t id, const SquareTests& tests, const SeenTriangle& seen) {
    std::vector<Place> inside, on_edge[3];
    for (int i = 0; i < 200; ++i) {
      const double a = random.uniform(), b = (1 - a) * random.uniform();
      inside.push_back(place_in(grid, id, {a, b, 1 - a - b}));
      for (size_t e = 0; e < 3; ++e) {
        std::array<double, 3> weights = {};
        weights[e] = a, weights[(e + 1) % 3] = 1 - a;
        on_edge[e].push_back(place_in(grid, id, weights));
      }
    }
    for (uint32_t cell = 0; cell < kAcross * kAcross; ++cell) {
      const CellSquare square = square_at(grid, cell % kAcross, cell / kAcross);
      const unsigned near = tests.edges_near_x(square.x) & tests.edges_near_y(square.y);
      InCell one;
      const bool is_met = tests.meet(square.x, square.y, near, one);
      const auto is_here = [&](Place p) { return outside(square, p) <= 0; };
      for (const Place p : inside) {
        if (!is_here(p)) continue;
        ASSERT_TRUE(is_met) << "triangle " << id << " cell " << cell;
        ASSERT_GE(p.s, one.lowest - 1e-6) << "triangle " << id << " cell " << cell;
        ASSERT_LE(p.s, one.highest + 1e-6) << "triangle " << id << " cell " << cell;
      }
      for (size_t e = 0; e < 3; ++e) {
        if (std::none_of(on_edge[e].begin(), on_edge[e].end(), is_here)) continue;
        ++edges;
        ASSERT_TRUE(is_met && (one.edges >> e & 1) != 0) << "triangle " << id << " cell " << cell << " edge " << e;
        ASSERT_FALSE(one.is_filled) << "triangle " << id << " cell " << cell << " edge " << e;
      }
      if (!is_met) continue;
      filled += one.is_filled;
      ASSERT_TRUE(!one.is_filled || seen.may_touch(square.x, square.y, 0)) << "triangle " << id << " cell " << cell;
    }
  });
  EXPECT_GT(filled, 50u);
  EXPECT_GT(edges, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Lights, CoverageSquares, testing::Bool(),
                         [](const auto& light) { return light.param ? "eye" : "parallel"; });

}  // namespace
}  // namespace raygrain
