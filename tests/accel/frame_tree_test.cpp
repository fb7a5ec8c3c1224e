// Trees in ray space against brute force, bit by bit: every kind of frame, columns and cones, every instruction set.
// RAYGRAIN_TEST_SCALE=full: both tests together ask more than ten million distinct rays as cones, and more as columns.
#include "raygrain/frame_tree.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <map>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/families.h"

#include "base/parallel.h"
#include "base/random.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

using test::same_bits;

size_t wanted_rays() {
  const char* variable = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string scale = variable != nullptr ? variable : "";
  if (scale == "full") return 15'500'000;
  return scale == "small" ? 1'000 : 25'000;
}

std::vector<uint32_t> all_triangles(const TriangleMesh& mesh) {
  std::vector<uint32_t> ids(mesh.triangle_count());
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

/// A ray that several frames serve alike is one ray and so many pairs; each pair is compared on each instruction set.
struct Count {
  size_t rays = 0, pairs = 0, comparisons = 0;

  void add(const Count& other) {
    rays += other.rays;
    pairs += other.pairs;
    comparisons += other.comparisons;
  }
};

struct Tally {
  Count columns, cones, unfit;  // `unfit.rays`: of no frame
  size_t rays = 0, hits = 0, complete = 0, differences = 0;
  std::string first_difference;

  Count& of(FrameUse use) { return use == FrameUse::kColumn ? columns : use == FrameUse::kCone ? cones : unfit; }
  void differ(const char* what, const FrameTree& tree, const Ray& ray, FrameUse use) {
    if (differences++ != 0) return;
    char text[300];
    std::snprintf(text, sizeof text, "%s of a %s, %s, %s: {{%a, %a, %a}, {%a, %a, %a}, %a, %a}", what,
                  use == FrameUse::kColumn ? "column" : "cone", name(tree.frame().kind), name(tree.isa()),
                  static_cast<double>(ray.origin.x), static_cast<double>(ray.origin.y),
                  static_cast<double>(ray.origin.z), static_cast<double>(ray.direction.x),
                  static_cast<double>(ray.direction.y), static_cast<double>(ray.direction.z),
                  static_cast<double>(ray.tmin), static_cast<double>(ray.tmax));
    first_difference = text;
  }
  void add(const Tally& other) {
    columns.add(other.columns);
    cones.add(other.cones);
    unfit.add(other.unfit);
    rays += other.rays;
    hits += other.hits;
    complete += other.complete;
    differences += other.differences;
    if (first_difference.empty()) first_difference = other.first_difference;
  }
};

/// The same tree for every instruction set.
std::vector<FrameTree> on_every_isa(const RayFrame& frame, const std::shared_ptr<const TriangleCorners>& mesh,
                                    std::span<const uint32_t> triangles, bool spatial,
                                    RayDensity density = RayDensity::kNearPlane) {
  std::vector<FrameTree> trees;
  for (const Isa isa : supported_isas()) {
    const auto tree = build_frame_tree(
        frame, mesh, triangles, {.z_term = spatial ? 0.1f : 0.0f, .density = density, .spatial = spatial, .isa = isa});
    if (tree) trees.push_back(*tree);
  }
  return trees;
}

/// Asks a tree in five ways. `complete_until`: hits with t up to it must be found, others may.
void compare(const FrameTree& tree, FrameUse use, const Ray& ray, const Hit& expected, float complete_until,
             Tally& tally) {
  if (tree.use_of(ray) != use) tally.differ("use", tree, ray, use);
  if (use == FrameUse::kUnfit) {
    if (tree.intersect(ray) || tree.occluded(ray)) tally.differ("use", tree, ray, use);
    return;
  }
  const std::optional<Hit> got = tree.intersect(ray);
  const std::optional<bool> shadow = tree.occluded(ray);
  TraceCounters counters;
  const std::optional<Hit> all = tree.intersect_counted(ray, counters, {}, {.prune = false});
  const std::optional<bool> any = tree.occluded_counted(ray, counters, {.prune = false});
  if (!got || !shadow || !all || !any) return tally.differ("use", tree, ray, use);
  const bool is_complete = std::min(expected.t, ray.tmax) <= complete_until;
  if (is_complete ? !same_bits(*got, expected) : is_nearer(*got, expected)) tally.differ("nearest", tree, ray, use);
  if (is_complete ? !same_bits(*all, expected) : is_nearer(*all, expected))
    tally.differ("unpruned nearest", tree, ray, use);
  if (is_complete ? *shadow != is_hit(expected) : *shadow && !is_hit(expected)) tally.differ("any", tree, ray, use);
  if (*any != *shadow) tally.differ("unpruned any", tree, ray, use);
  if (is_complete && !same_bits(*tree.intersect(ray, expected), expected)) tally.differ("known", tree, ray, use);
}

/// In all frames that there are trees for, on each instruction set.
void compare(std::span<const std::vector<FrameTree>> frames, const TriangleMesh& mesh, const Ray& ray,
             float complete_until, Tally& tally) {
  const Hit expected = intersect_reference(mesh, ray);
  ++tally.rays;
  tally.hits += is_hit(expected);
  tally.complete += std::min(expected.t, ray.tmax) <= complete_until;
  bool is_column = false, is_cone = false;
  for (const std::vector<FrameTree>& trees : frames) {
    const FrameUse use = trees.front().use_of(ray);
    is_column |= use == FrameUse::kColumn;
    is_cone |= use == FrameUse::kCone;
    tally.of(use).pairs += 1;
    tally.of(use).comparisons += trees.size();
    for (const FrameTree& tree : trees) compare(tree, use, ray, expected, complete_until, tally);
  }
  tally.columns.rays += is_column;
  tally.cones.rays += is_cone;
  tally.unfit.rays += !is_column && !is_cone;
}

/// Distinct rays along a direction, and leaning from it, most of these as cones do, through points where tracers fail.
std::vector<Ray> rays_along(const TriangleMesh& mesh, Vec3 direction, size_t count, uint64_t seed) {
  Random random(seed);
  const Bounds box = mesh_bounds(mesh);
  const double size = is_empty(box) ? 1 : length(to_double(box.hi) - to_double(box.lo));
  std::vector<Ray> rays = rays_from({}, mesh, count, seed);  // for their targets
  const Vec3d unit = normalized(to_double(direction));
  for (Ray& ray : rays) {
    const Vec3d target = to_double(ray.direction);
    const double away = random.uniform(-1, 1) * (size > 0 ? size : 1);
    Vec3d along = to_double(direction);
    const uint64_t kind = random.below(6);
    const double lean = kind < 2 ? 0 : std::pow(10.0, random.uniform(kind == 2 ? -8 : -3.5, -0.3));
    along = along + Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} * (lean * length(along));
    if (random.below(2)) along = -along;
    ray.origin = to_float(target - (kind == 0 ? unit : along / length(along)) * away);
    ray.direction = to_float(along);
    if (random.below(8) == 0) ray.origin = to_float(target);
    if (random.below(6) == 0) ray.tmin = static_cast<float>(random.uniform(-1, 1) * size / length(along));
    if (random.below(6) == 0) ray.tmax = ray.tmin + static_cast<float>(random.uniform(0, 1) * size / length(along));
    if (random.below(12) == 0) ray.tmax = static_cast<float>(away / length(along));  // it ends at its target
  }
  std::erase_if(rays, [](const Ray& ray) { return !is_valid(ray); });
  keep_distinct(rays);
  return rays;
}

std::string text_of(const Count& count) {
  return std::to_string(count.rays) + " (" + std::to_string(count.pairs) + " with frames, " +
         std::to_string(count.comparisons) + " with instruction sets)";
}

void report(const std::string& name, const Tally& tally) {
  EXPECT_EQ(tally.differences, 0u) << name << ": " << tally.first_difference;
  std::cout << name << ": " << tally.rays << " distinct rays, " << tally.hits << " hit; as columns "
            << text_of(tally.columns) << ", as cones " << text_of(tally.cones) << ", in no frame's reach "
            << text_of(tally.unfit) << "; " << tally.differences << " differences\n";
}

Tally in_parallel(size_t count, const std::function<void(size_t, Tally&)>& work) {
  std::vector<Tally> tallies(count);
  parallel_for(count, 256, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) work(i, tallies[i]);
  });
  Tally all;
  for (const Tally& tally : tallies) all.add(tally);
  return all;
}

TEST(FrameTree, ParallelRaysEqualBruteForce) {
  Tally total;
  const auto families = test::mesh_families(7);
  const size_t per_frame = std::max<size_t>(1, wanted_rays() / (families.size() * 8));
  for (size_t f = 0; f < families.size(); ++f) {
    const auto mesh = std::make_shared<const TriangleMesh>(families[f].mesh);
    const auto corners = std::make_shared<const TriangleCorners>(*mesh);
    const std::vector<uint32_t> ids = all_triangles(*mesh);
    Random random(f + 1);
    const Bounds box = mesh_bounds(*mesh);
    const Vec3 middle = is_empty(box) ? Vec3{} : center(box);
    for (int round = 0; round < 4; ++round) {
      Vec3 direction = to_float(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      if (round == 0) direction = {0, -1, 0};
      if (round == 1) direction = {0.5f, -1, 0.25f};
      for (const FrameKind kind : {FrameKind::kRotation, FrameKind::kShearX, FrameKind::kShearY, FrameKind::kShearZ}) {
        const auto frame = parallel_frame(kind, direction, middle);
        if (!frame) continue;
        const std::array trees{on_every_isa(*frame, corners, ids, random.below(2) != 0)};
        if (trees[0].empty()) continue;
        const std::vector<Ray> rays = rays_along(*mesh, direction, per_frame, random.next());
        const Tally tally =
            in_parallel(rays.size(), [&](size_t i, Tally& one) { compare(trees, *mesh, rays[i], kInf, one); });
        EXPECT_EQ(tally.differences, 0u) << families[f].name << ' ' << tally.first_difference;
        total.add(tally);
      }
    }
  }
  report("parallel rays", total);
  EXPECT_GT(total.columns.rays, total.rays / 3);
  EXPECT_GT(total.cones.rays, total.rays / 3);
}

/// The field of view of a point area; 0 for others.
float field_of(const InfluenceArea& area) {
  const auto* point = std::get_if<PointArea>(&area.shape);
  return point == nullptr ? 0 : point->fov_x;
}

TEST(FrameTree, RaysOfAreasEqualBruteForce) {
  Tally total;
  std::map<float, Tally> wide;  // by field of view
  const auto families = test::mesh_families(8);
  const size_t per_family = std::max<size_t>(14, wanted_rays() / families.size());
  for (size_t f = 0; f < families.size(); ++f) {
    const auto mesh = std::make_shared<const TriangleMesh>(families[f].mesh);
    const auto corners = std::make_shared<const TriangleCorners>(*mesh);
    const std::vector<uint32_t> ids = all_triangles(*mesh);
    for (const InfluenceArea& area : areas_around(*mesh, f + 5)) {
      const AreaGeometry geometry(area);
      std::vector<Ray> rays = rays_of_areas(*mesh, {area}, per_family / 7, f);
      std::erase_if(rays, [&](const Ray& ray) { return !(ray.tmin >= 0 && contains(geometry.region(), ray.origin)); });
      keep_distinct(rays);
      std::vector<std::vector<FrameTree>> frames;
      for (const FrameKind kind : frame_kinds(geometry)) {
        const RayFrame frame = *area_frame(kind, geometry);
        const bool is_solid = frame.is_projective() && f / 2 % 2 == 0;
        std::vector<FrameTree> trees =
            on_every_isa(frame, corners, ids, f % 2 == 0, is_solid ? RayDensity::kSolidAngle : RayDensity::kNearPlane);
        if (!trees.empty()) frames.push_back(std::move(trees));
      }
      if (frames.empty()) continue;
      const Tally tally = in_parallel(rays.size(), [&](size_t i, Tally& one) {
        compare(frames, *mesh, rays[i], exit_distance(geometry.region(), rays[i]), one);
      });
      EXPECT_EQ(tally.differences, 0u) << families[f].name << ' ' << area.name << ' ' << tally.first_difference;
      total.add(tally);
      if (field_of(area) >= 170) wide[field_of(area)].add(tally);
    }
  }
  report("rays of areas", total);
  EXPECT_EQ(wide.size(), 3u);
  for (const auto& [field, tally] : wide) {
    report("field of " + std::to_string(field), tally);
    EXPECT_GT(tally.columns.rays, 1u);
  }
  EXPECT_GT(total.complete, 100u);
  EXPECT_GT(total.columns.pairs, 250u);
  EXPECT_GT(total.cones.pairs, 250u);
}

TEST(FrameTree, EmptyTreesAndInvalidRays) {
  const auto mesh = std::make_shared<const TriangleMesh>(test::mesh_families(1).front().mesh);
  const auto corners = std::make_shared<const TriangleCorners>(*mesh);
  const RayFrame frame = *parallel_frame(FrameKind::kShearY, {0, -1, 0.25f}, {});
  const Hit known{3, 0.25f, 0.5f, 7};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const FrameTree& tree : {FrameTree(), *build_frame_tree(frame, corners, {})}) {
    EXPECT_EQ(tree.intersect({{0, 0, 0}, {0, -1, 0.25f}}, known), known);
    EXPECT_EQ(tree.occluded({{0, 0, 0}, {0, -1, 0.25f}}), false);
    EXPECT_EQ(tree.memory_bytes(), 0u);
  }
  const FrameTree tree = *build_frame_tree(frame, corners, all_triangles(*mesh));
  for (const Ray& ray : {Ray{{nan, 0, 0}, {0, -1, 0}}, Ray{{0, 0, 0}, {0, 0, 0}}, Ray{{0, 0, 0}, {0, -1, 0}, 2, 1},
                         Ray{{0, 0, 0}, {0, -1, 0}, nan, 1}, Ray{{0, kInf, 0}, {0, -1, 0}}}) {
    EXPECT_EQ(tree.intersect(ray, known), known);
    EXPECT_EQ(tree.occluded(ray), false);
  }
  EXPECT_EQ(tree.use_of({{0, 0, 0}, {1, 0, 0}}), FrameUse::kUnfit);
  EXPECT_THROW(FrameTree(frame, {}, nullptr), Error);
  EXPECT_THROW(build_frame_tree(frame, corners, {}, {.density = RayDensity::kSolidAngle}), Error);
}

}  // namespace
}  // namespace raygrain
