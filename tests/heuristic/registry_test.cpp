// Names to measures, orientations and builders: what is found, what is refused and with which words, what comes out.
#include "raygrain/registry.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "base/random.h"
#include "support/error_of.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

using test::error_of;

const Registry kRegistry = default_registry();

InfluenceArea sun() {
  PlaneArea plane;
  plane.center = {0, 20, 0};
  plane.direction = {0.3f, -1, 0.2f};
  plane.half_width = plane.half_height = 15;
  plane.depth = 60;
  return {"sun", plane};
}

InfluenceArea lamp() {
  PointArea point;
  point.eye = {0, 0, -20};
  return {"lamp", point};
}

std::vector<Ray> samples() {
  Random random(1);
  std::vector<Ray> rays;
  for (int i = 0; i < 50; ++i) {
    const auto x = static_cast<float>(random.uniform(-5, 5)), y = static_cast<float>(random.uniform(-5, 5));
    rays.push_back({{x, y, -30}, {0, 0, 1}});
  }
  return rays;
}

TEST(Recipes, AreReadInAnyCase) {
  const Recipe a = parse_recipe("pah+spfh", kRegistry);
  EXPECT_EQ(a.measure, "PAH");
  EXPECT_EQ(a.orientation, "SPFH");
  EXPECT_EQ(a.builder, "paper");
  const Recipe b = parse_recipe("Pah-Unculled+all@BINNED", kRegistry);
  EXPECT_EQ(b.measure, "PAH-UNCULLED");
  EXPECT_EQ(b.orientation, "ALL");
  EXPECT_EQ(b.builder, "binned");
}

TEST(Recipes, NamesRoundTrip) {
  for (const MeasureEntry& measure : kRegistry.measures)
    for (const OrientationEntry& orientation : kRegistry.orientations)
      for (const BuilderEntry& builder : kRegistry.builders) {
        const Recipe recipe{measure.name, orientation.name, builder.name, {}};
        const std::string name = recipe_name(recipe);
        EXPECT_EQ(name.find('@') == std::string::npos, builder.name == "paper");
        EXPECT_EQ(recipe_name(parse_recipe(name, kRegistry)), name);
      }
  EXPECT_EQ(recipe_name({}), "SAH+ALL");
}

struct BadRecipe {
  const char *text, *where, *hint;
};

const BadRecipe kBadRecipes[] = {
    {"", "recipe", "Known: SAH, PAH, PAH-UNCULLED, DIR, SOLID, SAMPLED, VISIBLE"},
    {"PAH", "recipe", "Did you mean PAH?"},
    {"PAH@paper", "recipe", "write MEASURE+ORIENTATION"},
    {"+", "measure", "Known: SAH"},
    {"PHA+SPFH", "measure", "Did you mean PAH? Known: SAH, PAH, PAH-UNCULLED, DIR, SOLID, SAMPLED, VISIBLE"},
    {"sampeld+ALL", "measure", "Did you mean SAMPLED?"},
    {"PAH+SPHF", "orientation", "Did you mean SPFH? Known: LSPH, SPFH, ALL, ROBIN"},
    {"PAH+", "orientation", "Known: LSPH"},
    {"PAH+ALL+ALL", "orientation", "Known: LSPH, SPFH, ALL, ROBIN"},
    {"PAH+ALL@", "builder", "Known: paper, binned"},
    {"PAH+ALL@bined", "builder", "Did you mean binned?"},
    {"PAH+ALL@paper@paper", "builder", "Known: paper, binned"},
    {" PAH+ALL", "measure", "Did you mean PAH?"},
};

TEST(Recipes, UnknownNamesAreRefusedWithTheNearest) {
  for (const BadRecipe& bad : kBadRecipes) {
    SCOPED_TRACE(bad.text);
    const Error error = error_of([&] { parse_recipe(bad.text, kRegistry); });
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    EXPECT_EQ(error.where, bad.where);
    EXPECT_NE(error.hint.find(bad.hint), std::string::npos) << error.hint;
  }
}

TEST(Recipes, LongNamesAreCutInTheMessage) {
  const Error error = error_of([] { parse_recipe(std::string(100000, 'x').append("+ALL"), kRegistry); });
  EXPECT_LT(std::string(error.what()).size(), 300u);
}

TEST(Needs, AreThoseOfTheParts) {
  const auto needs = [](const char* name) {
    const Recipe recipe = parse_recipe(name, kRegistry);
    return std::pair(needs_area(recipe, kRegistry), needs_samples(recipe, kRegistry));
  };
  EXPECT_EQ(needs("SAH+LSPH"), std::pair(false, false));
  EXPECT_EQ(needs("SAH+ROBIN@binned"), std::pair(false, false));
  EXPECT_EQ(needs("SAH+SPFH"), std::pair(true, false));
  EXPECT_EQ(needs("PAH+ALL"), std::pair(true, false));
  EXPECT_EQ(needs("DIR+ALL"), std::pair(true, false));
  EXPECT_EQ(needs("SAMPLED+ALL"), std::pair(false, true));
  EXPECT_EQ(needs("SAMPLED+SPFH"), std::pair(true, true));
}

TEST(Options, MissingAreaOrSamplesAreRefused) {
  for (const char* name : {"PAH+LSPH", "SAH+SPFH", "DIR+ALL", "SAMPLED+ALL"}) {
    const Error error = error_of([&] { make_build_options(parse_recipe(name, kRegistry), kRegistry, {}); });
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    EXPECT_EQ(error.where, name);
  }
}

TEST(Options, DirectionsNeedParallelRays) {
  const InfluenceArea point = lamp();
  const Error error = error_of([&] {
    make_build_options(parse_recipe("DIR+ALL", kRegistry), kRegistry, {&point, {}});
  });
  EXPECT_EQ(error.code, ErrorCode::kUsage);
  EXPECT_FALSE(error.hint.empty());
}

TEST(Options, ThePresetFallsBackToSurfaceAreaAndLongestAxis) {
  const InfluenceArea area = sun();
  Recipe recipe = parse_recipe("PAH+SPFH", kRegistry);
  recipe.parameters.bins = 17;
  recipe.parameters.split_plane_quality_threshold = 0.25f;
  const BuildOptions options = make_build_options(recipe, kRegistry, {&area, {}});
  EXPECT_EQ(options.parameters.bins, 17u);
  EXPECT_EQ(options.parameters.split_plane_quality_threshold, 0.25f);
  EXPECT_EQ(options.parameters.excellent_ratio, 0.9f);
  const Bounds box{{-1, 0, -1}, {3, 1, 1}};
  EXPECT_EQ(options.strategy.measure(box), projected_area_measure(area)(box));
  ASSERT_TRUE(options.fallback);
  EXPECT_EQ(options.fallback->measure(box), surface_area_measure()(box));
  NodeContext node;
  node.bounds = box;
  EXPECT_EQ(options.fallback->orientation(node).choices[0].axis, 0);
  EXPECT_EQ(options.strategy.orientation(node).choices[0].axis, 2);
}

TEST(Options, AllMeansEveryAxisAndNoEarlyStop) {
  const BuildOptions all = make_build_options(parse_recipe("SAH+ALL", kRegistry), kRegistry, {});
  EXPECT_EQ(all.parameters.split_plane_quality_threshold, 0);
  EXPECT_EQ(all.parameters.excellent_ratio, 0);
  EXPECT_EQ(all.parameters.acceptable_ratio, 1.3f);
}

/// Every valid combination of names builds a valid tree.
TEST(Trees, OfAllRecipesAreValid) {
  const std::vector<InfluenceArea> areas{sun(), lamp()};
  const std::vector<Ray> rays = samples();
  for (const NamedMesh& mesh : mesh_families(1)) {
    const std::vector<Bounds> bounds = triangle_bounds(mesh.mesh);
    const std::vector<Vec3> centroids = triangle_centroids(mesh.mesh);
    for (const InfluenceArea& area : areas)
      for (const MeasureEntry& measure : kRegistry.measures)
        for (const OrientationEntry& orientation : kRegistry.orientations)
          for (const BuilderEntry& builder : kRegistry.builders) {
            if (measure.name == "DIR" && area.name == "lamp") continue;
            const Recipe recipe{measure.name, orientation.name, builder.name, {}};
            SCOPED_TRACE(testing::Message() << mesh.name << " " << recipe_name(recipe) << " " << area.name);
            BuildLog log;
            const auto clip = [&](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh.mesh, i, box); };
            const Bvh bvh = build_tree(recipe, kRegistry, {&area, rays, clip}, bounds, centroids, &log);
            EXPECT_EQ(find_defect(bvh, bounds), std::nullopt);
            EXPECT_EQ(log.nodes.size(), bvh.nodes.size());
            if (builder.name != "paper" || orientation.name != "ALL") continue;
            for (size_t i = 0; i < bvh.nodes.size(); ++i) EXPECT_FALSE(log.nodes[i].forced) << "node " << i;
          }
  }
}

TEST(Qualities, NameBuilders) {
  for (const auto& [text, builder] : {std::pair{"fast", "subset"}, {"balanced", "binned"}, {"best", "spatial"}})
    EXPECT_EQ(builder_name(parse_quality(text)), std::string(builder));
  EXPECT_EQ(error_of([] { parse_quality("Best"); }).code, ErrorCode::kUsage);
}

TEST(Registry, OwnRowsWorkByName) {
  Registry own = default_registry();
  own.measures.push_back({"LENGTH", "sum of edges", false, false, [](const HeuristicInput&) {
                            return RayMeasure(
                                [](const Bounds& box) { return extent(box).x + extent(box).y + extent(box).z; });
                          }});
  const Recipe recipe = parse_recipe("length+all", own);
  EXPECT_EQ(recipe_name(recipe), "LENGTH+ALL");
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(make_build_options(recipe, own, {}).strategy.measure(box), 6);
  EXPECT_THROW(parse_recipe("length+all", default_registry()), Error);
}

}  // namespace
}  // namespace raygrain::test
