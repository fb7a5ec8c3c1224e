#include "raygrain/compare.h"

#include <bit>
#include <set>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "base/random.h"

namespace raygrain {
namespace {

/// Random triangles of many sizes, seen by a slanted sun and by a lamp among them.
Scene small_scene(size_t triangles = 300) {
  Scene scene;
  scene.name = "small";
  Random random(11);
  const auto uniform = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  for (uint32_t i = 0; i < triangles; ++i) {
    const Vec3 first{uniform(-8, 8), uniform(-8, 8), uniform(-8, 8)};
    const double size = i % 10 == 0 ? 6 : 1;
    scene.mesh.vertices.push_back(first);
    for (int k = 0; k < 2; ++k) {
      scene.mesh.vertices.push_back(first + Vec3{uniform(-size, size), uniform(-size, size), uniform(-size, size)});
    }
    scene.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.areas = {{"sun", PlaneArea{{0, 14, 0}, {0.2f, -1, 0.1f}, {0, 0, 1}, 5, 4, 25}},
                 {"lamp", PointArea{{0, 0, -3}, {0, 0.1f, 1}, {0, 1, 0}, 60, 50, 0.5f, 6}}};
  return scene;
}

CompareOptions few_rays() {
  CompareOptions options;
  options.rays = 400;
  options.verify = true;
  return options;
}

std::vector<std::string> row_names(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ComparisonRow& row : comparison.rows) names.push_back(row.area + " " + row.name);
  return names;
}

/// Everything but times, as bits.
std::vector<uint64_t> deterministic_bits(const Comparison& comparison) {
  std::vector<uint64_t> bits;
  for (const ComparisonRow& row : comparison.rows) {
    for (size_t i = 0; i < fields().size(); ++i) {
      if (fields()[i].deterministic) bits.push_back(std::bit_cast<uint64_t>(row.values.values[i]));
    }
  }
  return bits;
}

TEST(Compare, SixRowsPerAreaAndEveryHitRight) {
  const Scene scene = small_scene();
  const Comparison result = compare(scene, few_rays());
  EXPECT_EQ(result.scene, "small");
  EXPECT_EQ(result.triangles, scene.mesh.triangle_count());
  EXPECT_EQ(row_names(result),
            (std::vector<std::string>{"sun SAH+LSPH", "sun SAH+SPFH", "sun PAH+LSPH", "sun PAH+SPFH", "sun SAH+ALL",
                                      "sun PAH+ALL", "lamp SAH+LSPH", "lamp SAH+SPFH", "lamp PAH+LSPH", "lamp PAH+SPFH",
                                      "lamp SAH+ALL", "lamp PAH+ALL"}));
  for (const ComparisonRow& row : result.rows) {
    SCOPED_TRACE(row.area + " " + row.name);
    EXPECT_EQ(row.values[FieldId::kMismatches], 0);
    EXPECT_EQ(row.values[FieldId::kRays], 400);
    EXPECT_EQ(row.values[FieldId::kTriangles], static_cast<double>(row.local->tree->prims.size()));
    EXPECT_LE(row.values[FieldId::kPrunedCost], row.values[FieldId::kRealCost]);
    EXPECT_GT(row.values[FieldId::kHitRatio], 0);
    EXPECT_LT(row.values[FieldId::kTriangles], 300);  // neither area holds the whole scene
  }
}

TEST(Compare, EveryValueLiesInItsRange) {
  const Comparison result = compare(small_scene(), few_rays());
  for (const ComparisonRow& row : result.rows) {
    SCOPED_TRACE(row.area + " " + row.name);
    for (size_t i = 0; i < fields().size(); ++i) {
      if (!row.values.has(FieldId{i})) {
        EXPECT_TRUE(fields()[i].name.starts_with("top_level")) << fields()[i].name;
        continue;
      }
      EXPECT_GE(row.values.values[i], fields()[i].lowest) << fields()[i].name;
      EXPECT_LE(row.values.values[i], fields()[i].highest) << fields()[i].name;
    }
  }
}

TEST(Compare, SameNumbersForAnyThreadsAndAgain) {
  const Scene scene = small_scene(150);
  CompareOptions options = few_rays();
  options.threads = 1;
  const std::vector<uint64_t> once = deterministic_bits(compare(scene, options));
  EXPECT_EQ(deterministic_bits(compare(scene, options)), once);
  for (const unsigned threads : {2u, 8u}) {
    options.threads = threads;
    EXPECT_EQ(deterministic_bits(compare(scene, options)), once) << threads;
  }
  options.seed = 2;
  EXPECT_NE(deterministic_bits(compare(scene, options)), once);
}

TEST(Compare, TrianglesThatAreMissingFromLocalTreesShow) {
  CompareOptions options = few_rays();
  options.recipes = {parse_recipe("PAH+ALL", options.registry)};
  for (const bool verify : {false, true}) {
    options.verify = verify;
    options.membership = [](const AreaGeometry& area, Vec3 a, Vec3 b, Vec3 c) {
      return contains(area.region(), a) && contains(area.region(), b) && contains(area.region(), c);
    };
    const Comparison broken = compare(small_scene(), options);
    for (const ComparisonRow& row : broken.rows) EXPECT_GT(row.values[FieldId::kMismatches], 0) << row.area;
    options.membership = {};
    const Comparison whole = compare(small_scene(), options);
    for (const ComparisonRow& row : whole.rows) EXPECT_EQ(row.values[FieldId::kMismatches], 0) << row.area;
  }
}

TEST(Compare, OwnRecipesMeasuresAndGlobalTree) {
  CompareOptions options = few_rays();
  options.registry.measures.push_back(
      {"WIDE", "prefers boxes that are narrow along x", false, false,
       [](const HeuristicInput&) { return RayMeasure([](const Bounds& box) { return extent(box).x; }); }});
  options.recipes = {parse_recipe("WIDE+ALL@binned", options.registry), parse_recipe("SAMPLED+ALL", options.registry)};
  options.global = parse_recipe("SAH+ALL@binned", options.registry);
  const Comparison result = compare(small_scene(), options);
  ASSERT_EQ(result.rows.size(), 4u);
  EXPECT_EQ(result.rows[0].name, "WIDE+ALL@binned");
  for (const ComparisonRow& row : result.rows) EXPECT_EQ(row.values[FieldId::kMismatches], 0);
}

TEST(Compare, ProgressGrowsToOneAndNamesEachTree) {
  CompareOptions options = few_rays();
  std::vector<double> done;
  std::set<std::string> steps;
  options.progress = [&](const std::string& step, double d) {
    done.push_back(d);
    steps.insert(step);
    return true;
  };
  compare(small_scene(50), options);
  EXPECT_EQ(done.front(), 0);
  EXPECT_EQ(done.back(), 1);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_TRUE(steps.contains("sun: PAH+SPFH"));
  EXPECT_TRUE(steps.contains("lamp: SAH+ALL"));
}

TEST(Compare, CancelledAtAnyStep) {
  CompareOptions options = few_rays();
  for (const int last : {0, 1, 3, 7}) {
    int calls = 0;
    options.progress = [&](const std::string&, double) { return calls++ < last; };
    try {
      compare(small_scene(50), options);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kCancelled);
    }
    EXPECT_EQ(calls, last + 1);
  }
}

ErrorCode code_of(const Scene& scene, const CompareOptions& options) {
  try {
    compare(scene, options);
  } catch (const Error& error) {
    return error.code;
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kLimit;
}

TEST(Compare, RefusesWhatCannotBeMeant) {
  Scene scene = small_scene(20);
  CompareOptions options = few_rays();
  options.rays = 0;
  EXPECT_EQ(code_of(scene, options), ErrorCode::kUsage);
  options = few_rays();
  options.recipes = {Recipe{"NOPE", "ALL", "paper", {}}};
  EXPECT_EQ(code_of(scene, options), ErrorCode::kUsage);
  options = few_rays();
  options.global = Recipe{"PAH", "ALL", "paper", {}};  // no area to project for
  EXPECT_EQ(code_of(scene, options), ErrorCode::kUsage);
  options = few_rays();
  std::get<PlaneArea>(scene.areas[0].shape).half_width = 0;
  EXPECT_EQ(code_of(scene, options), ErrorCode::kBadArea);
  scene.areas.clear();
  EXPECT_EQ(code_of(scene, options), ErrorCode::kUsage);
}

TEST(Compare, AreaThatHoldsNothing) {
  Scene scene = small_scene(60);
  scene.areas = {{"away", PlaneArea{{500, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, 5}}};
  const Comparison result = compare(scene, few_rays());
  for (const ComparisonRow& row : result.rows) {
    EXPECT_EQ(row.values[FieldId::kMismatches], 0);
    EXPECT_EQ(row.values[FieldId::kNodes], 0);
    EXPECT_EQ(row.values[FieldId::kRealCost], 0);
  }
}

TEST(BestRow, PrunedThenRealThenOrder) {
  Comparison comparison;
  const auto add = [&](const char* area, double pruned, double real) {
    ComparisonRow row;
    row.area = area;
    row.values[FieldId::kPrunedCost] = pruned;
    row.values[FieldId::kRealCost] = real;
    comparison.rows.push_back(row);
  };
  add("a", 5, 1);
  add("b", 1, 1);
  add("a", 4, 9);
  add("a", 4, 8);
  add("a", 4, 8);
  EXPECT_EQ(best_row(comparison, "a"), 3u);
  EXPECT_EQ(best_row(comparison, "b"), 1u);
  EXPECT_EQ(best_row(comparison, "a", 3), 4u);
  EXPECT_THROW(best_row(comparison, "c"), Error);
  EXPECT_THROW(best_row(comparison, "b", 1), Error);
}

TEST(SampleRays, AreNoneOfThoseTraced) {
  const InfluenceArea area = generate_scene({"random100"}).areas.at(0);
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Ray> samples = sample_rays(area, 1, 2), traced = cast_rays(AreaRays{.area = area}, 2, seed);
    ASSERT_EQ(samples.size(), 2u);
    ASSERT_NE(samples[0].origin, traced[0].origin);
  }
}

TEST(SampleRays, AreAsManyAsTheMeasureCanUse) {
  const Registry registry = default_registry();
  EXPECT_EQ(sample_count({"VISIBLE", "ALL", "binned", {}}, registry), 4096u);
  EXPECT_EQ(sample_count({"SAMPLED", "ALL", "binned", {}}, registry), 1000u);
}

TEST(PaperRecipes, NamesAndPreset) {
  std::vector<std::string> names;
  for (const Recipe& recipe : paper_recipes()) {
    names.push_back(recipe_name(recipe));
    EXPECT_EQ(recipe.builder, "paper");
    EXPECT_EQ(recipe.parameters.split_plane_quality_threshold, 0.4f);
    EXPECT_EQ(recipe.parameters.bins, 40u);
    EXPECT_EQ(recipe.parameters.max_triangles_per_leaf, 2u);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"SAH+LSPH", "SAH+SPFH", "PAH+LSPH", "PAH+SPFH", "SAH+ALL", "PAH+ALL"}));
}

}  // namespace
}  // namespace raygrain
