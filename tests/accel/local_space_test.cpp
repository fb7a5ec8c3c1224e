// Which areas get trees of their own.
#include <gtest/gtest.h>

#include "raygrain/accelerator.h"

#include "accel/scenes.h"

namespace raygrain {
namespace {

using test::random_mesh;
using test::some_areas;

/// Without a space coverage answers for areas; whoever asks for their trees gets them.
TEST(LocalSpace, BuildsLocalTreesWhereOptionsAskForThem) {
  const TriangleMesh mesh = random_mesh(50, 4);
  const auto trees = [&](auto... set) {
    AcceleratorOptions options;
    (set(options), ...);
    const Accelerator scene(mesh, some_areas(), options);
    EXPECT_EQ(scene.local_trees().empty(), local_space(options) == LocalSpace::kNone);
    EXPECT_EQ(scene.coverages().empty(), !options.coverage || options.traversal == Traversal::kBinary);
    return scene.local_trees().size();
  };
  using Options = AcceleratorOptions;
  const size_t all = some_areas().size();
  EXPECT_EQ(trees(), 0u);
  EXPECT_EQ(trees([](Options& o) { o.reinsert = true; }), 0u);  // the global tree alone
  EXPECT_EQ(trees([](Options& o) { o.space = LocalSpace::kWorld; }), all);
  EXPECT_EQ(trees([](Options& o) { o.coverage.reset(); }), all);
  EXPECT_EQ(trees([](Options& o) { o.traversal = Traversal::kBinary; }), all);
  EXPECT_EQ(trees([](Options& o) { o.routing = Routing::kAreas; }), all);
  EXPECT_EQ(trees([](Options& o) { o.local.measure = "SAH"; }), all);
  EXPECT_EQ(trees([](Options& o) { o.reinsert_local = true; }), all);
  EXPECT_EQ(trees([](Options& o) { o.wide_measure = "SAH"; }), all);
  EXPECT_EQ(trees([](Options& o) { o.membership = [](const auto&, Vec3, Vec3, Vec3) { return true; }; }), all);
  EXPECT_EQ(trees([](Options& o) { o.space = LocalSpace::kNone, o.routing = Routing::kAreas; }), 0u);
}

}  // namespace
}  // namespace raygrain
