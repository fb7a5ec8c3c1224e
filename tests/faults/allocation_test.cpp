// Every allocation of a small piece of work fails once: std::bad_alloc or an Error comes out, nothing is lost, and the
// next try gives what it always gives.
#include <filesystem>
#include <new>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/analyze.h"
#include "raygrain/build.h"
#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/refine.h"

#include "faults/failing_allocations.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

TriangleMesh mesh_of(const std::string& name) {
  for (NamedMesh& named : mesh_families(1))
    if (named.name == name) return std::move(named.mesh);
  ADD_FAILURE() << name;
  return {};
}

/// Runs `work`, which returns something comparable, with each allocation failing in its turn; at most `most` of them,
/// evenly chosen.
template <class Work>
void with_each_allocation_failing(const Work& work, size_t most = 2000) {
  const auto expected = work();  // also fills what is made once, such as static tables
  fail_allocation(0);
  ASSERT_EQ(work(), expected);
  const size_t allocations = allocations_since();
  ASSERT_GT(allocations, 0u);
  const size_t step = 1 + allocations / most, live = live_blocks();
  for (size_t n = 1; n <= allocations; n += step) {
    bool failed = false, equal = false;
    fail_allocation(n);
    try {
      equal = work() == expected;  // where a buffer is a wish only
    } catch (const std::bad_alloc&) {
      failed = true;
    } catch (const Error& error) {
      failed = error.code == ErrorCode::kLimit || error.code == ErrorCode::kUnwritable;
    }
    fail_allocation(0);
    ASSERT_TRUE(failed || equal) << "allocation " << n << " of " << allocations;
    ASSERT_EQ(live_blocks(), live) << "allocation " << n << " of " << allocations;
  }
  ASSERT_EQ(work(), expected);
}

BuildOptions one_thread() {
  BuildOptions options;
  options.threads = 1;
  return options;
}

struct Built {
  std::vector<uint32_t> links, prims;
  friend bool operator==(const Built&, const Built&) = default;
};
Built contents(const Bvh& tree) {
  Built built{{}, tree.prims};
  for (const Bvh::Node& node : tree.nodes) built.links.insert(built.links.end(), {node.first, node.count});
  return built;
}

TEST(FailedAllocation, OfABuild) {
  const TriangleMesh mesh = mesh_of("soup");
  const std::vector<Bounds> boxes = triangle_bounds(mesh);
  const std::vector<Vec3> centroids = triangle_centroids(mesh);
  BuildOptions options = one_thread();
  options.clip = [&](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh, i, box); };
  options.fallback = BuildStrategy{};
  for (const auto build : {build_paper, build_binned, build_sweep, build_spatial, build_subset})
    with_each_allocation_failing([&] {
      BuildLog log;
      return contents(build(boxes, centroids, options, &log));
    });
}

TEST(FailedAllocation, OfAnImprovement) {
  const TriangleMesh mesh = mesh_of("soup");
  const std::vector<Bounds> boxes = triangle_bounds(mesh);
  const Bvh tree = build_binned(boxes, {}, one_thread());
  with_each_allocation_failing([&] {
    Bvh better = tree;
    reinsert(better, {}, {.threads = 1});
    refit(better, boxes);
    return contents(better);
  });
}

TEST(FailedAllocation, OfAnAccelerator) {
  const TriangleMesh mesh = mesh_of("closed_sphere");
  std::vector<InfluenceArea> areas = point_light_areas("lamp", {0.1f, 5, 0.2f}, mesh_bounds(mesh));
  areas.push_back(directional_light_area("sun", {0.3f, -1, 0.2f}, mesh_bounds(mesh)));
  const std::vector<Ray> rays = aimed_rays(mesh, 40, 1);
  AcceleratorOptions options;
  options.threads = 1;
  for (const LocalSpace space : {LocalSpace::kWorld, LocalSpace::kRay}) {
    options.space = space;
    with_each_allocation_failing(
        [&] {
          const Accelerator accelerator(mesh, areas, options);
          std::vector<Hit> hits(rays.size());
          accelerator.intersect(rays, hits, 1);
          return hits;
        },
        seed_count(40));
  }
}

TEST(FailedAllocation, OfFiles) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = mesh_of("soup");
  const Bvh tree = build_binned(triangle_bounds(mesh), {}, one_thread());
  const std::vector<Ray> rays = aimed_rays(mesh, 40, 1);
  with_each_allocation_failing(
      [&] {
        save_tree(tree, folder.file("a.rgt"));
        save_mesh(mesh, folder.file("a.ply"));
        save_mesh(mesh, folder.file("a.obj"));
        save_rays(rays, folder.file("a.csv"));
        load_mesh(folder.file("a.obj"));
        load_rays(folder.file("a.csv"));
        load_mesh(folder.file("a.ply"));
        return contents(load_tree(folder.file("a.rgt")));
      },
      seed_count(100));
  size_t names = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
    ++names;
  }
  EXPECT_EQ(names, 4u);
}

TEST(FailedAllocation, OfAnImportInAChild) {
  const TemporaryFolder folder;
  save_mesh(mesh_of("closed_sphere"), folder.file("a.ply"));
  with_each_allocation_failing(
      [&] { return load_mesh(folder.file("a.ply"), {.isolation = Isolation::kChildProcess}).triangles; }, 100);
}

}  // namespace
}  // namespace raygrain::test
