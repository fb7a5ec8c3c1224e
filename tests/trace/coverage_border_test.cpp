// Batches of rays exactly on the borders of a coverage's window, tiles and cells, and one float inside and outside,
// against brute force, bit for bit, on every instruction set. The borders are those of the grid itself.
#include <array>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "raygrain/coverage.h"

#include "base/random.h"
#include "trace/coverage_answers.h"
#include "trace/coverage_grid.h"

namespace raygrain {
namespace {

using test::Tally;

struct Sides {
  size_t below = 0, on = 0, above = 0;
};

enum class Border { kWindow, kTile, kCell };

/// Places of a grid's borders, and points of the world there.
class BorderPoints {
 public:
  BorderPoints(const CoverageGrid& grid, uint64_t seed) : grid_(grid), random_(seed) {}

  /// Points on the border and a float's step to each side, appended to `points`; `sides` counts where they lie, seen in
  /// double precision and rounded to float.
  void append(Border border, std::vector<Vec3>& points, Sides& sides) {
    const int axis = static_cast<int>(random_.below(2));
    const float at = place_of(border, axis);
    Vec3d place{somewhere(0), somewhere(1), depth()};
    if (random_.below(4) == 0) place[1 - axis] = place_of(border, 1 - axis);  // a corner
    place[axis] = at;
    const Vec3 p = to_float(world(place));
    for (int step = -1; step < 6; ++step) {
      Vec3 q = p;
      if (step >= 0) q[step / 2] = std::nextafter(q[step / 2], step % 2 == 0 ? -kInf : kInf);
      points.push_back(q);
      const auto seen = static_cast<float>(image(q)[axis]);
      ++(seen < at ? sides.below : seen > at ? sides.above : sides.on);
    }
  }

 private:
  float lo(int axis) const { return axis == 0 ? grid_.x_lo : grid_.y_lo; }
  float hi(int axis) const { return axis == 0 ? grid_.x_hi : grid_.y_hi; }
  double somewhere(int axis) { return random_.uniform(static_cast<double>(lo(axis)), static_cast<double>(hi(axis))); }

  float place_of(Border border, int axis) {
    if (border == Border::kWindow) return random_.below(2) == 0 ? lo(axis) : hi(axis);
    const size_t number = random_.below(grid_.tiles.size());
    const size_t tile = axis == 0 ? number % grid_.tiles_x : number / grid_.tiles_x;
    double place = static_cast<double>(tile);
    const uint32_t across = grid_.tiles[number].across;
    if (border == Border::kCell) place += static_cast<double>(random_.below(across + 1)) / across;
    return static_cast<float>(static_cast<double>(lo(axis)) + place / static_cast<double>(grid_.tiles_per_unit));
  }

  /// About that of a vertex.
  double depth() {
    const TriangleMesh& mesh = *grid_.mesh;
    const Vec3d q = grid_.map.turned(mesh.vertex(random_.below(mesh.triangle_count()), 0));
    const double factors[] = {1, 1.0001, 0.9999, 2, 0.5};
    const double factor = factors[random_.below(std::size(factors))];
    if (grid_.map.is_eye) return factor / (q.z > 0 ? q.z : 1);
    const double size = static_cast<double>(grid_.s_hi) - static_cast<double>(grid_.s_lo);
    return q.z + (factor - 1) * 0.25 * size;
  }

  Vec3d image(Vec3 p) const {
    const Vec3d q = grid_.map.turned(p);
    return grid_.map.is_eye ? Vec3d{q.x / q.z, q.y / q.z, 1 / q.z} : q;
  }

  Vec3d world(Vec3d place) const {
    const Vec3d q = grid_.map.is_eye ? Vec3d{place.x, place.y, 1} / place.z : place;
    const auto& [x, y, z] = grid_.map.rows;
    const Vec3d v = (cross(y, z) * q.x + cross(z, x) * q.y + cross(x, y) * q.z) / dot(x, cross(y, z));
    return to_double(grid_.map.center) + v;
  }

  const CoverageGrid& grid_;
  Random random_;
};

/// What is asked about one area: points on its borders, and directions from an eye to them.
struct Questions {
  std::vector<Vec3> points, directions;
  std::vector<Ray> any, nearest;
};

struct Totals {
  Tally any, nearest;
  std::array<Sides, 3> sides;
};

Questions questions_on_borders(const CoverageGrid& grid, const InfluenceArea& area, uint64_t seed, Totals& totals) {
  Questions questions;
  BorderPoints borders(grid, seed);
  for (const Border border : {Border::kWindow, Border::kTile, Border::kCell})
    for (uint64_t i = 0; i < test::seed_count(12); ++i)
      borders.append(border, questions.points, totals.sides[static_cast<size_t>(border)]);
  const auto* point = std::get_if<PointArea>(&area.shape);
  for (const Vec3 p : questions.points) {
    if (point != nullptr) {
      questions.directions.push_back(p - point->eye);
      questions.any.push_back({p, point->eye - p, 0, 1});
      questions.nearest.push_back({point->eye, p - point->eye, 0, kInf});
    } else {
      const Vec3 light = std::get<PlaneArea>(area.shape).direction;
      questions.any.push_back({p, -light, 0, kInf});
      questions.nearest.push_back({p, light, 0, kInf});
    }
  }
  return questions;
}

void expect_right(const Coverage& coverage, const InfluenceArea& area, const Questions& questions,
                  const std::vector<uint8_t>& expected_flags, const std::vector<Hit>& expected_hits, Totals& totals) {
  std::vector<uint8_t> flags(questions.points.size());
  std::vector<Hit> hits(questions.points.size());
  std::vector<uint32_t> rest_of_any, rest_of_nearest;
  if (const auto* point = std::get_if<PointArea>(&area.shape)) {
    coverage.occluded_towards(questions.points, point->eye, flags, rest_of_any);
    coverage.intersect_from(point->eye, questions.directions, hits, rest_of_nearest);
  } else {
    const Vec3 light = std::get<PlaneArea>(area.shape).direction;
    coverage.occluded(questions.points, -light, flags, rest_of_any);
    coverage.intersect(questions.points, light, hits, rest_of_nearest);
  }
  test::expect_flags(expected_flags, flags, rest_of_any, totals.any);
  test::expect_hits(expected_hits, hits, rest_of_nearest, totals.nearest);
  test::expect_same_singly(coverage, questions.any, flags, rest_of_any);
  test::expect_same_singly(coverage, questions.nearest, hits, rest_of_nearest);
}

void try_area(const std::shared_ptr<const TriangleMesh>& mesh, const InfluenceArea& area, uint64_t seed,
              Totals& totals) {
  SCOPED_TRACE(area.name);
  CoverageOptions options{seed % 2 == 0 ? 0.25f : 4.0f, 16};
  options.threads = 1;
  const CoverageGrid grid = build_coverage(
      mesh, AreaGeometry(area),
      {static_cast<double>(options.cells_per_triangle), static_cast<double>(options.triangles_per_tile)}, nullptr, 1);
  if (!grid.is_useful()) return;
  const Questions questions = questions_on_borders(grid, area, seed, totals);
  const std::vector<uint8_t> flags = test::oracle_flags(*mesh, questions.any);
  const std::vector<Hit> hits = test::oracle_hits(*mesh, questions.nearest);
  for (const Isa isa : supported_isas()) {
    SCOPED_TRACE(name(isa));
    options.isa = isa;
    options.order = kCoverageOrders[seed++ % std::size(kCoverageOrders)];
    expect_right(Coverage(mesh, area, options), area, questions, flags, hits, totals);
    if (testing::Test::HasFatalFailure()) return;
  }
}

void expect_all_sides(const Totals& totals) {
  for (const Sides& sides : totals.sides) {
    EXPECT_GT(sides.below, 100u);
    EXPECT_GT(sides.on, 100u);
    EXPECT_GT(sides.above, 100u);
  }
  EXPECT_GT(totals.any.answered, totals.any.asked / 10);
  EXPECT_GT(totals.any.hits, totals.any.answered / 20);
  EXPECT_GT(totals.nearest.answered, totals.nearest.asked / 20);
  EXPECT_GT(totals.nearest.hits, totals.nearest.answered / 10);
}

TEST(CoverageBorder, OfPlaneAreas) {
  Totals totals;
  test::for_families(1, [&](const std::shared_ptr<const TriangleMesh>& mesh, uint64_t seed) {
    const Bounds box = mesh_bounds(*mesh);
    const double size = length(to_double(extent(box)));
    if (!(size > 1e-30)) return;
    for (const Vec3 light : {Vec3{0, -1, 0}, Vec3{0.3f, -0.8f, 0.45f}}) {
      try_area(mesh, directional_light_area("sun", light, box), seed, totals);
      const Vec3d back = normalized(to_double(light)) * size, middle = to_double(center(box));
      const auto part = [&](double share) { return static_cast<float>(share * size); };
      // Its window cuts the scene.
      try_area(mesh, {"narrow", PlaneArea{to_float(middle - back), light, {1, 0, 0}, part(0.2), part(0.15), part(2)}},
               seed + 1, totals);
    }
  });
  expect_all_sides(totals);
}

TEST(CoverageBorder, OfPointAreas) {
  Totals totals;
  test::for_families(1, [&](const std::shared_ptr<const TriangleMesh>& mesh, uint64_t seed) {
    const Bounds box = mesh_bounds(*mesh);
    const double size = length(to_double(extent(box)));
    if (!(size > 1e-30)) return;
    const Vec3d middle = to_double(center(box));
    const Vec3 eye = to_float(middle + normalized(Vec3d{0.4, 0.8, -0.3}) * (0.8 * size));
    const auto part = [&](double share) { return static_cast<float>(share * size); };
    for (const float fov : {12.0f, 80.0f, 170.0f})
      try_area(mesh,
               {"camera " + std::to_string(fov),
                PointArea{eye, to_float(middle - to_double(eye)), {0, 1, 0}, fov, fov, part(0.01), part(3)}},
               seed, totals);
    const std::vector<InfluenceArea> lamp = point_light_areas("lamp", to_float(middle), box);
    try_area(mesh, lamp[seed % lamp.size()], seed, totals);
  });
  expect_all_sides(totals);
}

}  // namespace
}  // namespace raygrain
