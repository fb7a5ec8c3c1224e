// Structures under verification: drawn at random, and made again from their names.
#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/families.h"
#include "raygrain/refine.h"
#include "raygrain/verify.h"
#include "raygrain/wide.h"

#include "build/build_support.h"
#include "verify/aspects.h"
#include "verify/spec.h"

namespace raygrain {
namespace {

TEST(RandomStructures, AreMadeAgainFromTheirNames) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const std::string name = random_structure(seed).name;
    EXPECT_EQ(parse_structure(name).name, name);
  }
  for (const char* wrong :
       {"", "wood", "wide leaf", "wide leaf=x", "wide leaf=-1", "wide colour=1", "wide reinserted=2"})
    EXPECT_THROW(parse_structure(wrong), Error) << wrong;
}

TEST(RandomStructures, AreOfEveryKind) {
  std::set<std::string> words;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    std::string name = random_structure(seed).name;
    std::ranges::replace(name, '@', ' ');
    std::istringstream in(name);
    for (std::string word; in >> word;) words.insert(word);
  }
  std::vector<std::string> expected{"binary",
                                    "wide",
                                    "frame",
                                    "coverage",
                                    "accelerator",
                                    "paper",
                                    "binned",
                                    "sweep",
                                    "spatial",
                                    "subset",
                                    "reinserted=1",
                                    "refitted=1",
                                    "from_file=1",
                                    "leaf=1",
                                    "leaf=7",
                                    "batch=1",
                                    "batch=17",
                                    "batch=5000",
                                    "threads=3",
                                    "threads=0",
                                    "areas=0",
                                    "octree=0",
                                    "ray_space=1",
                                    "covered=0",
                                    "traversal=binary",
                                    "counted=1",
                                    "unpruned=1",
                                    "order=as-given",
                                    "order=runs",
                                    "order=open-by-tile",
                                    "order=by-tile",
                                    "order=by-cell",
                                    "frame=rotation",
                                    "frame=shear_x",
                                    "frame=projective",
                                    "of_area=1",
                                    "spatial=0",
                                    "for_wide=1",
                                    "tree=RANDOM+ALL",
                                    "tree=PAH+SPFH",
                                    "local=VISIBLE+ROBIN",
                                    "local=DIR+LSPH",
                                    "tree=SAMPLED+ALL",
                                    "by_own_measure=1",
                                    "local_trees=0",
                                    "reinserted_local=1",
                                    "wide_measure=VISIBLE",
                                    "wide_measure=RANDOM",
                                    "wide_measure=DIR",
                                    "area_frame=shear_z",
                                    "area_frame=projective",
                                    "quality=fast",
                                    "quality=best",
                                    "solid_angle=1",
                                    "tree=SOLID+ALL",
                                    "local=SOLID+ALL",
                                    "wide_measure=SOLID"};
  for (const Isa isa : supported_isas())
    if (isa != Isa::kScalar) expected.push_back(std::string("isa=") + name(isa));
  for (const std::string& word : expected) EXPECT_EQ(words.count(word), 1u) << word;
}

using namespace verification;

VerifyScene scene_with_areas() {
  VerifyScene scene{"scene", std::make_shared<const TriangleMesh>(random_family_mesh(200, 3).mesh), {}};
  scene.areas = {directional_light_area("sun", {0.3f, -0.9f, 0.2f}, mesh_bounds(*scene.mesh)),
                 {"lamp", PointArea{{9, 4, 1}, {-1, 0, 0}, {0, 0, 1}, 90, 90, 0.01f, 100}}};
  return scene;
}

TEST(RandomStructures, WordsReachTheAccelerator) {
  const AcceleratorOptions usual = accelerator_options(parse_spec("accelerator"));
  EXPECT_EQ(usual.space, LocalSpace::kWorld);
  EXPECT_FALSE(usual.reinsert || usual.reinsert_local || usual.frame || usual.quality);
  EXPECT_EQ(usual.wide_measure, "");
  const AcceleratorOptions given = accelerator_options(
      parse_spec("accelerator reinserted=1 reinserted_local=1 ray_space=1 area_frame=shear_x quality=best "
                 "wide_measure=VISIBLE"));
  EXPECT_EQ(given.space, LocalSpace::kRay);
  EXPECT_TRUE(given.reinsert && given.reinsert_local);
  EXPECT_EQ(given.frame, FrameKind::kShearX);
  EXPECT_EQ(given.quality, Quality::kBest);
  EXPECT_EQ(given.wide_measure, "VISIBLE");
  EXPECT_EQ(usual.density, RayDensity::kNearPlane);
  EXPECT_EQ(accelerator_options(parse_spec("accelerator seed=3 solid_angle=1")).density, RayDensity::kSolidAngle);
  EXPECT_EQ(accelerator_options(parse_spec("accelerator seed=3")).density, RayDensity::kNearPlane);
  EXPECT_EQ(accelerator_options(parse_spec("accelerator local_trees=0")).space, LocalSpace::kNone);
  EXPECT_EQ(accelerator_areas(parse_spec("accelerator wide_measure=DIR"), scene_with_areas()).size(), 1u);
  EXPECT_THROW(accelerator_options(parse_spec("accelerator area_frame=wood")), Error);
}

TEST(RandomStructures, AreReinsertedByTheirOwnMeasureWhereTheNameSaysSo) {
  const VerifyScene scene = scene_with_areas();
  const StructureSpec spec = parse_spec("binary tree=VISIBLE+ALL@binned seed=7");
  const Bvh plain = make_tree(spec, scene);
  const Bvh by_surface = make_tree(parse_spec("binary tree=VISIBLE+ALL@binned seed=7 reinserted=1"), scene);
  const Bvh by_own =
      make_tree(parse_spec("binary tree=VISIBLE+ALL@binned seed=7 reinserted=1 by_own_measure=1"), scene);
  EXPECT_FALSE(test::same_tree(by_own, by_surface));
  // Wide forms by VISIBLE are made by the measure that the tree of this recipe has.
  const RayMeasure visible = wide_measure(parse_spec("wide wide_measure=VISIBLE seed=7"), scene);
  Bvh expected = plain;
  reinsert(expected, visible, {.threads = 1});
  EXPECT_TRUE(test::same_tree(by_own, expected));
  const Bounds root = plain.nodes[0].bounds;
  EXPECT_EQ(wide_measure(parse_spec("wide"), scene)(root), surface_area_measure()(root));
  // Its samples end at what they hit: not a constant times PAH.
  const RayMeasure base = wide_measure(parse_spec("wide wide_measure=PAH seed=7"), scene);
  std::set<int> ratios;
  for (const Bvh::Node& node : plain.nodes)
    if (base(node.bounds) > 0)
      ratios.insert(static_cast<int>(100 * visible(node.bounds) / base(node.bounds) * base(root)));
  EXPECT_GT(ratios.size(), 10u);
}

/// Rays of a lamp whose region reaches beyond floats have directions all the same.
TEST(RandomStructures, FramesOfHugeAreasCanBeMade) {
  VerifyScene scene = scene_with_areas();
  PointArea lamp;
  lamp.fov_x = lamp.fov_y = 150;
  lamp.near_z = 0x1p127f;
  lamp.far_z = 0x1.8p127f;
  scene.areas = {{"lamp", lamp}};
  for (const char* frame : {"rotation", "shear_x", "shear_y", "shear_z"})
    EXPECT_NO_THROW(make_frame(parse_spec(std::string("frame seed=1 frame=") + frame), scene)) << frame;
}

bool counts(const std::string& structure, const VerifyScene& scene, const std::string& aspect) {
  return std::ranges::count(aspects_of(structure, scene, RayGroupKind::kMixed), aspect) == 1;
}

TEST(RandomStructures, AreCountedByWhatTheyAreForTheScene) {
  const VerifyScene scene = scene_with_areas();
  VerifyScene bare = scene;
  bare.areas.clear();
  EXPECT_TRUE(counts("wide tree=VISIBLE+ALL", scene, "wide, measure VISIBLE"));
  EXPECT_FALSE(counts("wide tree=VISIBLE+ALL", bare, "measure VISIBLE"));  // there is no area to see from
  EXPECT_TRUE(counts("wide tree=VISIBLE+ALL", bare, "measure SAH"));
  EXPECT_TRUE(counts("wide wide_measure=VISIBLE", scene, "wide, wide forms by VISIBLE"));
  EXPECT_FALSE(counts("wide wide_measure=VISIBLE", bare, "wide forms by VISIBLE"));
  const std::string local = "accelerator local=VISIBLE+ALL@binned wide_measure=PAH ";
  EXPECT_TRUE(counts(local, scene, "accelerator, measure VISIBLE"));
  EXPECT_TRUE(counts(local, scene, "wide forms by PAH"));
  EXPECT_FALSE(counts(local, bare, "measure VISIBLE"));
  EXPECT_FALSE(counts(local + "local_trees=0", scene, "measure VISIBLE"));
  EXPECT_TRUE(counts(local + "local_trees=0", scene, "accelerators without local trees"));
  EXPECT_TRUE(counts(local + "reinserted_local=1", scene, "reinserted by VISIBLE"));
  EXPECT_TRUE(counts("accelerator tree=PAH+ALL quality=best", bare, "builder spatial"));
  const std::string density = "accelerator, density solid-angle";
  const std::string solid = "accelerator ray_space=1 solid_angle=1 ";
  EXPECT_TRUE(counts(solid, scene, density));
  EXPECT_FALSE(counts(solid, bare, density));
  EXPECT_FALSE(counts(solid + "wide_measure=DIR", scene, density));  // plane areas alone
  EXPECT_FALSE(counts("accelerator solid_angle=1", scene, density));
  EXPECT_TRUE(counts("frame frame=projective of_area=1 solid_angle=1", scene, "frame, density solid-angle"));
  EXPECT_FALSE(counts("frame frame=projective of_area=1", scene, "density solid-angle"));
  EXPECT_FALSE(counts("frame frame=rotation solid_angle=1", scene, "density solid-angle"));
}

}  // namespace
}  // namespace raygrain
