// Every ray through every combination of builder, measure, orientation and top level, compared bit by bit with brute
// force. RAYGRAIN_TEST_SCALE=full: more than a million rays instead of fifty thousand; small: a few thousand, for
// builds with sanitizers.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/families.h"
#include "raygrain/rays.h"
#include "raygrain/refine.h"

#include "base/parallel.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

using test::same_bits;

using test::NamedMesh;

constexpr uint64_t kSeed = 20;

/// Aimed at this many distinct rays over all families.
size_t wanted_rays() {
  const char* variable = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string scale = variable != nullptr ? variable : "";
  if (scale == "full") return 1'050'000;
  return scale == "small" ? 2'500 : 50'000;
}

std::vector<Ray> sample_rays(const InfluenceArea* area) {
  return area != nullptr ? cast_rays(AreaRays{*area}, 64, 1) : std::vector<Ray>{};
}

/// Is there such a tree for this area, or without one (null)?
bool is_valid_for(const Recipe& recipe, const Registry& registry, const InfluenceArea* area) {
  if (area == nullptr) return !needs_area(recipe, registry) && !needs_samples(recipe, registry);
  return recipe.measure != "DIR" || std::holds_alternative<PlaneArea>(area->shape);
}

std::vector<Recipe> all_recipes(const Registry& registry) {
  std::vector<Recipe> recipes;
  for (const BuilderEntry& builder : registry.builders)
    for (const MeasureEntry& measure : registry.measures)
      for (const OrientationEntry& orientation : registry.orientations)
        recipes.push_back({measure.name, orientation.name, builder.name, {}});
  return recipes;
}

struct Combination {
  std::string name;
  Accelerator accelerator;
};

/// At small scale each recipe meets every other family.
std::vector<Recipe> recipes_for(size_t family, const Registry& registry) {
  std::vector<Recipe> recipes = all_recipes(registry);
  if (test::seed_count(4) > 1) return recipes;
  size_t i = 0;
  std::erase_if(recipes, [&](const Recipe&) { return (i++ + family) % 2 == 0; });
  return recipes;
}

/// Each recipe for all areas that it is valid for, with list and octree; the global trees in turn, and each alone. Half
/// of each kind is searched as binary trees, half as wide ones.
std::vector<Combination> all_combinations(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas,
                                          size_t family) {
  const Registry registry = default_registry();
  const std::vector<Recipe> recipes = recipes_for(family, registry);
  const auto shared_mesh = std::make_shared<const TriangleMesh>(mesh);
  std::vector<Combination> combinations;
  std::vector<std::shared_ptr<const Bvh>> globals;
  for (const Recipe& recipe : recipes) {
    if (!is_valid_for(recipe, registry, nullptr)) continue;
    globals.push_back(std::make_shared<const Bvh>(build_global_tree(mesh, recipe, registry)));
    const bool wide = globals.size() % 2 == 0;
    combinations.push_back(
        {"global " + recipe_name(recipe),
         Accelerator(shared_mesh, {}, globals.back(), {}, wide ? Traversal::kWide : Traversal::kBinary)});
    Bvh reinserted = *globals.back();
    reinsert(reinserted);
    combinations.push_back({"reinserted " + recipe_name(recipe),
                            Accelerator(shared_mesh, {}, std::make_shared<const Bvh>(std::move(reinserted)), {},
                                        wide ? Traversal::kBinary : Traversal::kWide)});
  }
  for (const Recipe& recipe : recipes) {
    std::vector<LocalTree> locals;
    for (const InfluenceArea& area : areas)
      if (is_valid_for(recipe, registry, &area))
        locals.push_back(build_local_tree(mesh, area, recipe, registry, {}, sample_rays(&area)));
    const auto& global = globals[combinations.size() % globals.size()];
    for (const TopLevelKind kind : {TopLevelKind::kList, TopLevelKind::kOctree}) {
      const bool wide = (kind == TopLevelKind::kOctree) == (combinations.size() / 2 % 2 == 0);
      const std::string name = recipe_name(recipe) + (kind == TopLevelKind::kList ? " list" : " octree");
      combinations.push_back(
          {name + (wide ? " wide" : " binary"),
           Accelerator(shared_mesh, locals, global, {kind, 4}, wide ? Traversal::kWide : Traversal::kBinary)});
    }
  }
  return combinations;
}

struct Tally {
  size_t rays = 0, hits = 0, combinations = 0, comparisons = 0, differences = 0, leaks = 0;
  uint64_t local_searches = 0, local_hits = 0, continued = 0, globals = 0;
  std::string first_difference;

  void add(const Tally& other) {
    rays += other.rays;
    hits += other.hits;
    combinations = std::max(combinations, other.combinations);
    comparisons += other.comparisons;
    differences += other.differences;
    leaks += other.leaks;
    local_searches += other.local_searches;
    local_hits += other.local_hits;
    continued += other.continued;
    globals += other.globals;
    if (first_difference.empty()) first_difference = other.first_difference;
  }
};

std::ostream& operator<<(std::ostream& out, const Tally& t) {
  return out << t.rays << " distinct rays (" << t.hits << " hit), " << t.combinations << " combinations, "
             << t.comparisons << " comparisons, " << t.differences << " differences, " << t.leaks << " leaks; "
             << t.local_searches << " local searches, " << t.local_hits << " local answers, " << t.continued
             << " steps from area to area, " << t.globals << " global searches";
}

std::string describe(const Ray& ray, const Hit& got, const Hit& expected) {
  char text[400];
  std::snprintf(
      text, sizeof text, "ray {%a, %a, %a} {%a, %a, %a} %a %a: got t %a u %a v %a id %u, expected %a %a %a %u",
      static_cast<double>(ray.origin.x), static_cast<double>(ray.origin.y), static_cast<double>(ray.origin.z),
      static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.y), static_cast<double>(ray.direction.z),
      static_cast<double>(ray.tmin), static_cast<double>(ray.tmax), static_cast<double>(got.t),
      static_cast<double>(got.u), static_cast<double>(got.v), got.triangle, static_cast<double>(expected.t),
      static_cast<double>(expected.u), static_cast<double>(expected.v), expected.triangle);
  return text;
}

void check_counters(const AcceleratorCounters& c, size_t rays) {
  EXPECT_EQ(c.rays, rays);
  EXPECT_LE(c.areas_serving, c.areas_tested);
  EXPECT_LE(c.local_searches, c.areas_serving);
  EXPECT_LE(c.local_hits, c.local_searches);
  EXPECT_LE(c.continued, c.local_searches);
  EXPECT_LE(c.invalid_rays + c.local_hits + c.global_searches, c.rays);
  EXPECT_LE(c.local.triangle_tests, c.local.leaf_triangles);
}

/// t, u, v and id, bit by bit.
/// All rays through one combination: counted and not, one by one and as arrays.
Tally compare(const Combination& combination, const std::vector<Ray>& rays, const std::vector<Hit>& expected) {
  Tally tally;
  const Accelerator& accelerator = combination.accelerator;
  AcceleratorCounters counters;
  std::vector<Hit> counted(rays.size());
  std::vector<uint8_t> shadows(rays.size());
  accelerator.intersect(rays, counted, 1, &counters);
  accelerator.occluded(rays, shadows, 1);
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit plain = i % 4 == 0 ? accelerator.intersect(rays[i]) : counted[i];
    const Hit& got = same_bits(plain, expected[i]) ? counted[i] : plain;
    const bool shadow = shadows[i] != 0;
    tally.comparisons += 2;
    if (same_bits(got, expected[i]) && shadow == is_hit(expected[i])) continue;
    ++tally.differences;
    if (tally.first_difference.empty())
      tally.first_difference = combination.name + ": " + describe(rays[i], got, expected[i]) +
                               (shadow == is_hit(expected[i]) ? "" : ", occluded differs");
  }
  check_counters(counters, rays.size());
  tally.local_searches = counters.local_searches;
  tally.local_hits = counters.local_hits;
  tally.continued = counters.continued;
  tally.globals = counters.global_searches;
  return tally;
}

std::vector<Hit> brute_force(const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  parallel_for(rays.size(), 64, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) hits[i] = intersect_reference(mesh, rays[i]);
  });
  return hits;
}

Tally compare_all(const NamedMesh& family, size_t number, size_t count, uint64_t seed) {
  const std::vector<InfluenceArea> areas = areas_around(family.mesh, seed);
  std::vector<Ray> rays = test::aimed_rays(family.mesh, count / 2, seed);
  for (const Ray& ray : rays_of_areas(family.mesh, areas, count - rays.size(), seed)) rays.push_back(ray);
  keep_distinct(rays);
  const std::vector<Hit> expected = brute_force(family.mesh, rays);
  const std::vector<Combination> combinations = all_combinations(family.mesh, areas, number);
  std::vector<Tally> tallies(combinations.size());
  parallel_for(combinations.size(), 1, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) tallies[i] = compare(combinations[i], rays, expected);
  });
  Tally all;
  for (const Tally& tally : tallies) all.add(tally);
  all.rays = rays.size();
  all.combinations = combinations.size();
  all.hits = static_cast<size_t>(std::ranges::count_if(expected, is_hit));
  return all;
}

/// Rays from inside a closed mesh towards its vertices, edges and faces: each must hit.
size_t leaks(const NamedMesh& family, size_t count, uint64_t seed) {
  const Accelerator scene(family.mesh, areas_around(family.mesh, seed));
  size_t missed = 0;
  for (const Ray& ray : rays_from(family.inside, family.mesh, count, seed))
    missed += is_hit(scene.intersect(ray)) && scene.occluded(ray) ? 0 : 1;
  return missed;
}

const std::vector<NamedMesh>& families() {
  static const std::vector<NamedMesh> all = test::mesh_families(kSeed);
  return all;
}

class Differential : public testing::TestWithParam<size_t> {
 protected:
  static void TearDownTestSuite() { std::cout << "all families: " << total_ << "\n"; }
  static inline Tally total_;
};

TEST_P(Differential, EveryCombinationEqualsBruteForce) {
  const NamedMesh& family = families()[GetParam()];
  const size_t count = wanted_rays() / families().size() + 1;
  Tally tally = compare_all(family, GetParam(), count, kSeed + GetParam());
  if (family.closed) tally.leaks = leaks(family, count, kSeed + GetParam());
  std::cout << family.name << ": " << tally << "\n";
  total_.add(tally);
  EXPECT_EQ(tally.differences, 0u) << tally.first_difference;
  EXPECT_EQ(tally.leaks, 0u);
  // The rays do what they are here for: most are distinct, and areas answer many of them.
  EXPECT_GT(tally.rays, count * 9 / 10);
  if (family.closed) {
    EXPECT_GT(tally.local_hits, tally.rays);
    EXPECT_GT(tally.continued, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Differential, testing::Range<size_t>(0, families().size()),
                         [](const testing::TestParamInfo<size_t>& family) {
                           std::string name = families()[family.param].name;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace raygrain
