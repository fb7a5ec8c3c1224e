// Trees that know what rays see: of a building whose inside no ray gets to.
#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "support/full_building.h"

namespace raygrain {
namespace {

constexpr size_t kSamples = 2000;

std::vector<InfluenceArea> areas_of(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  return {directional_light_area("axis", {0, -1, 0}, box), directional_light_area("oblique", {0.3f, -0.8f, 0.5f}, box),
          camera_area("camera", {-150, 120, 30}, {50, 50, 50}, 60, 1.5f, box)};
}

AcceleratorOptions options_for(const char* measure) {
  AcceleratorOptions options;
  options.local = {measure, "ALL", "binned", {}};
  options.coverage.reset();
  options.routing = Routing::kAreas;
  options.samples = [](const InfluenceArea* area) {
    return area != nullptr ? cast_rays(AreaRays{*area}, kSamples, 1) : std::vector<Ray>{};
  };
  return options;
}

std::vector<uint32_t> shape_of(const Bvh& tree) {
  std::vector<uint32_t> shape = tree.prims;
  for (const Bvh::Node& node : tree.nodes) shape.insert(shape.end(), {node.first, node.count});
  return shape;
}

/// Nodes and triangles that the area's own rays visit.
uint64_t work_of(const Accelerator& accelerator, size_t area, bool is_any) {
  const InfluenceArea& own = accelerator.local_trees()[area].area;
  TraceCounters counters;
  for (const Ray& ray : cast_rays(AreaRays{own}, 2000, 2)) {
    const Bvh& tree = *accelerator.local_trees()[area].tree;
    if (is_any)
      occluded(tree, accelerator.mesh(), ray, {}, &counters);
    else
      EXPECT_EQ(intersect(tree, accelerator.mesh(), ray, {}, {}, &counters), accelerator.intersect(ray));
  }
  return counters.inner_hits + counters.leaf_triangles;
}

TEST(Visibility, TreesOfAnAcceleratorSpareWhatNoRaySees) {
  const TriangleMesh mesh = test::full_building(6000, 1);
  const Accelerator plain(mesh, areas_of(mesh), options_for("PAH")),
      visible(mesh, areas_of(mesh), options_for("VISIBLE"));
  for (size_t area = 0; area < 3; ++area) {
    SCOPED_TRACE(plain.local_trees()[area].area.name);
    EXPECT_NE(shape_of(*plain.local_trees()[area].tree), shape_of(*visible.local_trees()[area].tree));
    const uint64_t before = work_of(plain, area, false), after = work_of(visible, area, false);
    EXPECT_LT(10 * after, 9 * before);
  }
}

TEST(Visibility, EveryPathToATreeEndsItsSamples) {
  const TriangleMesh mesh = test::full_building(1000, 2);
  const InfluenceArea area = areas_of(mesh)[1];
  const Recipe recipe{"VISIBLE", "ALL", "binned", {}}, sampled{"SAMPLED", "ALL", "binned", {}};
  const Registry registry = default_registry();
  const std::vector<Ray> endless = cast_rays(AreaRays{area}, kSamples, 1);
  const Bvh global = build_global_tree(mesh, Recipe{"SAH", "LSPH", "paper", {}}, registry);
  const std::vector<Ray> ended = samples_for(recipe, registry, endless, mesh, &global);
  ASSERT_EQ(ended.size(), endless.size());
  for (size_t i = 0; i < ended.size(); ++i)
    EXPECT_EQ(ended[i].tmax, std::min(kInf, intersect_reference(mesh, endless[i]).t));
  const auto ends_of = [&](const Recipe& about, std::span<const Ray> samples, const Bvh* tree) {
    std::vector<float> ends;
    for (const Ray& ray : samples_for(about, registry, samples, mesh, tree)) ends.push_back(ray.tmax);
    return ends;
  };
  const std::vector<float> expected = ends_of(recipe, endless, &global);
  EXPECT_EQ(ends_of(recipe, endless, nullptr), expected);  // by a tree of its own
  EXPECT_EQ(ends_of(recipe, ended, nullptr), expected);
  EXPECT_EQ(ends_of(sampled, endless, &global), std::vector<float>(kSamples, kInf));
  const LocalTree from_ended = build_local_tree(mesh, area, recipe, registry, {}, ended),
                  from_endless = build_local_tree(mesh, area, recipe, registry, {}, endless);
  EXPECT_EQ(shape_of(*from_ended.tree), shape_of(*from_endless.tree));
  const Accelerator accelerator(mesh, {area}, options_for("VISIBLE"));
  EXPECT_EQ(shape_of(*accelerator.local_trees()[0].tree), shape_of(*from_ended.tree));
}

/// Splits, reinsertion and the order of children can each be had alone, and with each other.
TEST(Visibility, EachUseCanBeChosen) {
  const TriangleMesh mesh = test::full_building(3000, 3);
  const auto nodes_of = [&](const AcceleratorOptions& options) {
    const Accelerator accelerator(mesh, {areas_of(mesh)[1]}, options);
    AcceleratorCounters counters;
    for (const Ray& ray : cast_rays(AreaRays{areas_of(mesh)[1]}, 1000, 2)) accelerator.occluded(ray, &counters);
    return counters.local.inner_hits + counters.local.leaf_triangles;
  };
  AcceleratorOptions options = options_for("PAH");
  const uint64_t plain = nodes_of(options);
  options.wide_measure = "VISIBLE";
  EXPECT_NE(nodes_of(options), plain);
  options = options_for("VISIBLE");
  const Accelerator split(mesh, {areas_of(mesh)[1]}, options);
  options.reinsert_local = true;
  const Accelerator reinserted(mesh, {areas_of(mesh)[1]}, options);
  EXPECT_LT(reinserted.local_trees()[0].predicted_cost, split.local_trees()[0].predicted_cost);
  EXPECT_NE(work_of(reinserted, 0, false), work_of(split, 0, false));
  options.wide_measure = "VISBLE";
  EXPECT_THROW(Accelerator(mesh, {areas_of(mesh)[1]}, options), Error);
}

}  // namespace
}  // namespace raygrain
