// The facade: parts, errors, determinism, sharing.
#include "raygrain/accelerator.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "accel/scenes.h"
#include "base/parallel.h"
#include "base/random.h"
#include "build/estimate.h"

namespace raygrain {
namespace {

using test::add_floor;
using test::error_of;
using test::random_mesh;
using test::some_areas;
using test::z_area;

bool same_tree(const Bvh& a, const Bvh& b) {
  return a.prims == b.prims && std::ranges::equal(a.nodes, b.nodes, [](const Bvh::Node& x, const Bvh::Node& y) {
           return x.bounds == y.bounds && x.first == y.first && x.count == y.count;
         });
}

TEST(Accelerator, MembersAreTheTrianglesThatOverlap) {
  const TriangleMesh mesh = random_mesh(300, 1);
  for (const InfluenceArea& area : some_areas()) {
    SCOPED_TRACE(area.name);
    const AreaGeometry geometry(area);
    const std::vector<uint32_t> members = area_members(mesh, geometry);
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < mesh.triangle_count(); ++i)
      if (overlaps(geometry.region(), mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2))) expected.push_back(i);
    EXPECT_EQ(members, expected);
    EXPECT_GT(members.size(), 0u);
    EXPECT_LT(members.size(), mesh.triangle_count());

    const LocalTree local = build_local_tree(mesh, area, {"PAH", "ALL", "paper", {}}, default_registry());
    std::vector<uint32_t> held = local.tree->prims;
    std::ranges::sort(held);
    EXPECT_EQ(held, members);
    EXPECT_EQ(find_defect(*local.tree, triangle_bounds(mesh), members), std::nullopt);
    EXPECT_EQ(local.log.nodes.size(), local.tree->nodes.size());
  }
}

TEST(Accelerator, MembershipIsInjectable) {
  const TriangleMesh mesh = random_mesh(50, 2);
  const AreaGeometry geometry(z_area("sun", -2, 4));
  size_t asked = 0;
  const MembershipRule rule = [&](const AreaGeometry& area, Vec3 a, Vec3, Vec3) {
    ++asked;
    EXPECT_EQ(area.area().name, "sun");
    return a.x > 0;
  };
  const std::vector<uint32_t> members = area_members(mesh, geometry, rule);
  EXPECT_EQ(asked, 50u);
  for (uint32_t i = 0; i < 50; ++i) EXPECT_EQ(std::ranges::binary_search(members, i), mesh.vertex(i, 0).x > 0);
}

TEST(Accelerator, PredictedCostIsPricedUnderTheTreesOwnMeasure) {
  const TriangleMesh mesh = random_mesh(200, 3);
  const Registry registry = default_registry();
  for (const InfluenceArea& area : some_areas())
    for (const char* name : {"PAH+ALL", "SAH+LSPH", "PAH+SPFH@binned"}) {
      SCOPED_TRACE(area.name + " " + name);
      const Recipe recipe = parse_recipe(name, registry);
      const LocalTree local = build_local_tree(mesh, area, recipe, registry);
      const BuildOptions options = make_build_options(recipe, registry, {&area, {}});
      EXPECT_GT(local.predicted_cost, 0);
      EXPECT_EQ(local.predicted_cost, estimated_cost(*local.tree, options.strategy.measure, options.costs));
    }
}

TEST(Accelerator, ThreadsDoNotChangeTheTrees) {
  const TriangleMesh mesh = random_mesh(500, 4);
  AcceleratorOptions options;
  options.space = LocalSpace::kWorld;
  options.threads = 1;
  const Accelerator one(mesh, some_areas(), options);
  for (const unsigned threads : {2u, 4u, 0u}) {
    options.threads = threads;
    const Accelerator many(mesh, some_areas(), options);
    EXPECT_TRUE(same_tree(one.global_tree(), many.global_tree()));
    ASSERT_EQ(one.local_trees().size(), many.local_trees().size());
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(same_tree(*one.local_trees()[i].tree, *many.local_trees()[i].tree));
      EXPECT_EQ(one.local_trees()[i].predicted_cost, many.local_trees()[i].predicted_cost);
      EXPECT_EQ(one.local_trees()[i].area.name, many.local_trees()[i].area.name);
    }
  }
}

TEST(Accelerator, ManyThreadsMayAskAtOnce) {
  AcceleratorOptions options;
  options.routing = Routing::kAreas;
  const Accelerator scene(random_mesh(300, 5), some_areas(), options);
  std::vector<Ray> rays;
  for (const InfluenceArea& area : some_areas())
    for (const Ray& ray : cast_rays(AreaRays{area, RayStart::kRandomDepth}, 300, 7)) rays.push_back(ray);
  std::vector<Hit> hits(rays.size());
  std::vector<AcceleratorCounters> counters(rays.size());
  parallel_for(rays.size(), 16, 4, [&](size_t begin, size_t end) {
    const Accelerator copy = scene;
    for (size_t i = begin; i < end; ++i) hits[i] = copy.intersect(rays[i], &counters[i]);
  });
  AcceleratorCounters sum, expected;
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(hits[i], intersect_reference(scene.mesh(), rays[i]));
    scene.intersect(rays[i], &expected);
    sum.add(counters[i]);
  }
  EXPECT_EQ(sum, expected);
  EXPECT_EQ(sum.rays, rays.size());
  EXPECT_GT(sum.local.box_tests, 0u);
}

TEST(Accelerator, PartsMayBeShared) {
  const auto mesh = std::make_shared<const TriangleMesh>(random_mesh(100, 6));
  const Registry registry = default_registry();
  const auto global = std::make_shared<const Bvh>(build_global_tree(*mesh, {"SAH", "ALL", "binned", {}}, registry));
  std::vector<LocalTree> locals;
  for (const InfluenceArea& area : some_areas())
    locals.push_back(build_local_tree(*mesh, area, {"PAH", "ALL", "paper", {}}, registry));
  const Accelerator list(mesh, locals, global, {TopLevelKind::kList}), octree(mesh, locals, global);
  EXPECT_EQ(&list.mesh(), mesh.get());
  EXPECT_EQ(&octree.global_tree(), global.get());
  EXPECT_EQ(list.local_trees()[1].tree.get(), octree.local_trees()[1].tree.get());
  EXPECT_EQ(list.top_level().kind(), TopLevelKind::kList);
  EXPECT_EQ(octree.top_level().kind(), TopLevelKind::kOctree);
  EXPECT_GT(octree.memory_bytes(), memory_bytes(*global) + octree.top_level().memory_bytes());
  for (const Ray& ray : cast_rays(AreaRays{some_areas()[0]}, 200, 1))
    ASSERT_EQ(list.intersect(ray), octree.intersect(ray));
}

TEST(Accelerator, OtherLocalTreesShareMeshAndGlobalTree) {
  const Accelerator without(random_mesh(200, 6));
  std::vector<LocalTree> locals;
  for (const InfluenceArea& area : some_areas())
    locals.push_back(build_local_tree(without.mesh(), area, {"PAH", "ALL", "binned", {}}, default_registry()));
  const Accelerator with = without.with_local_trees(locals, {TopLevelKind::kList});
  EXPECT_EQ(&with.mesh(), &without.mesh());
  EXPECT_EQ(&with.global_tree(), &without.global_tree());
  EXPECT_EQ(with.local_trees().size(), 3u);
  EXPECT_EQ(with.top_level().kind(), TopLevelKind::kList);
  EXPECT_EQ(with.traversal(), Traversal::kWide);
  AcceleratorCounters counters;
  for (const Ray& ray : cast_rays(AreaRays{some_areas()[0]}, 200, 1))
    ASSERT_EQ(with.intersect(ray, &counters), without.intersect(ray));
  EXPECT_GT(counters.local_hits, 0u);
  locals[1].tree = nullptr;
  EXPECT_EQ(error_of([&] { without.with_local_trees(locals); }).where, "areas[1] 'lamp'");
}

TEST(Accelerator, WideTreesCostMemoryAndSaveNodes) {
  const TriangleMesh mesh = random_mesh(500, 16);
  AcceleratorOptions options;
  options.coverage = std::nullopt;
  options.routing = Routing::kAreas;
  const Accelerator wide(mesh, some_areas(), options);
  options.traversal = Traversal::kBinary;
  const Accelerator binary(mesh, some_areas(), options);
  EXPECT_EQ(binary.wide_memory_bytes(), 0u);
  EXPECT_GT(wide.wide_memory_bytes(), mesh.triangle_count() * 40);
  EXPECT_EQ(wide.memory_bytes(), binary.memory_bytes() + wide.wide_memory_bytes());
  const std::vector<Ray> rays = cast_rays(AreaRays{some_areas()[0], RayStart::kRandomDepth}, 500, 3);
  std::vector<Hit> through_wide(rays.size()), through_binary(rays.size());
  AcceleratorCounters in_wide, in_binary;
  wide.intersect(rays, through_wide, 1, &in_wide);
  binary.intersect(rays, through_binary, 1, &in_binary);
  EXPECT_EQ(through_wide, through_binary);
  EXPECT_LT(in_wide.local.inner_hits, in_binary.local.inner_hits);
  EXPECT_EQ(in_wide.local_searches, in_binary.local_searches);
}

TEST(Accelerator, ArraysAreAnsweredAsSingleRaysAre) {
  for (const Traversal traversal : {Traversal::kWide, Traversal::kBinary})
    for (const bool with_areas : {false, true}) {
      AcceleratorOptions options;
      options.traversal = traversal;
      const Accelerator scene(random_mesh(300, 15), with_areas ? some_areas() : std::vector<InfluenceArea>{}, options);
      std::vector<Ray> rays = cast_rays(AreaRays{some_areas()[1], RayStart::kRandomDepth}, 3000, 5);
      rays[7].direction = {};
      std::vector<Hit> expected;
      std::vector<uint8_t> expected_flags;
      AcceleratorCounters expected_counters, expected_shadows;
      for (const Ray& ray : rays) {
        expected.push_back(scene.intersect(ray, &expected_counters));
        expected_flags.push_back(scene.occluded(ray, &expected_shadows) ? 1 : 0);
      }
      for (const unsigned threads : {1u, 3u, 0u}) {
        std::vector<Hit> hits(rays.size()), counted(rays.size());
        std::vector<uint8_t> flags(rays.size()), counted_flags(rays.size());
        AcceleratorCounters counters, shadows;
        scene.intersect(rays, hits, threads);
        scene.intersect(rays, counted, threads, &counters);
        scene.occluded(rays, flags, threads);
        scene.occluded(rays, counted_flags, threads, &shadows);
        EXPECT_EQ(hits, expected);
        EXPECT_EQ(counted, expected);
        EXPECT_EQ(counters, expected_counters);
        EXPECT_EQ(flags, expected_flags);
        EXPECT_EQ(counted_flags, expected_flags);
        EXPECT_EQ(shadows, expected_shadows);
      }
      std::vector<Hit> short_by_one(rays.size() - 1);
      EXPECT_EQ(error_of([&] { scene.intersect(rays, short_by_one); }).code, ErrorCode::kUsage);
    }
}

TEST(Accelerator, TellsProgressAndCanBeCancelled) {
  const TriangleMesh mesh = random_mesh(3000, 17);
  for (const unsigned threads : {1u, 2u}) {
    std::vector<double> told;
    AcceleratorOptions options;
    options.threads = threads;
    options.reinsert = true;
    options.progress = [&](double done) {
      told.push_back(done);
      return true;
    };
    const Accelerator whole(mesh, some_areas(), options);
    ASSERT_GE(told.size(), 4u);
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_NEAR(told.back(), 1, 1e-9);
    const size_t calls = told.size();
    for (const size_t stop : {size_t{1}, calls / 2, calls}) {
      told.clear();
      options.progress = [&](double done) {
        told.push_back(done);
        return told.size() < stop;
      };
      EXPECT_EQ(error_of([&] { Accelerator(mesh, some_areas(), options); }).code, ErrorCode::kCancelled);
      EXPECT_EQ(told.size(), stop);
    }
  }
}

/// Trees are built side by side: where one is stopped the others must not go on with half of their loops.
TEST(Accelerator, IsCancelledCleanlyWhileSeveralTreesAreBuilt) {
  const TriangleMesh mesh = random_mesh(20000, 18);
  for (size_t stop = 1; stop < 60; stop += 2) {
    AcceleratorOptions options;
    options.coverage = std::nullopt;
    size_t calls = 0;
    options.progress = [&](double) { return ++calls < stop; };
    try {
      const Accelerator whole(mesh, some_areas(), options);
      EXPECT_LT(calls, stop);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kCancelled);
      EXPECT_EQ(calls, stop);
    }
  }
}

TEST(Accelerator, WorksWithoutAreasAndWithoutTriangles) {
  const Accelerator no_areas(random_mesh(20, 7));
  AcceleratorCounters counters;
  const Ray ray{{0, 0, -5}, {0.1f, 0, 1}};
  EXPECT_EQ(no_areas.intersect(ray, &counters), intersect_reference(no_areas.mesh(), ray));
  EXPECT_EQ(counters.global_searches, 1u);
  const Accelerator empty(TriangleMesh{}, some_areas());
  EXPECT_FALSE(is_hit(empty.intersect(ray)));
  EXPECT_FALSE(is_hit(empty.intersect({{0, 0, -1}, {0, 0, 1}})));
  EXPECT_FALSE(empty.occluded({{0, 0, -1}, {0, 0, 1}}));
}

TEST(Accelerator, SampleRaysReachTheirMeasures) {
  AcceleratorOptions options;
  options.local = {"SAMPLED", "ALL", "binned", {}};
  const Error missing = error_of([&] { Accelerator(random_mesh(20, 8), some_areas(), options); });
  EXPECT_EQ(missing.code, ErrorCode::kUsage);
  options.samples = [](const InfluenceArea* area) {
    return area != nullptr ? cast_rays(AreaRays{*area}, 200, 1) : std::vector<Ray>{};
  };
  const Accelerator scene(random_mesh(100, 8), some_areas(), options);
  for (const LocalTree& local : scene.local_trees()) EXPECT_GT(local.predicted_cost, 0);
  for (const Ray& ray : cast_rays(AreaRays{some_areas()[1]}, 200, 2))
    ASSERT_EQ(scene.intersect(ray), intersect_reference(scene.mesh(), ray));
}

}  // namespace
}  // namespace raygrain
