// What a seed draws, it draws everywhere: compilers are free to draw the arguments of a call in any order.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/families.h"
#include "raygrain/verify.h"

#include "support/fingerprint.h"
#include "verify/round.h"

namespace raygrain::test {
namespace {

// The CPU decides about the instruction set.
std::string without_isa(std::string name) {
  if (const size_t at = name.find(" isa="); at != std::string::npos) name.erase(at, name.find(' ', at + 1) - at);
  return name;
}

// What these seeds drew before newer words and measures came.
TEST(Draws, OfStructures) {
  EXPECT_EQ(without_isa(random_structure(0).name),
            "accelerator tree=RANDOM+LSPH@spatial local=DIR+ROBIN@binned octree=0 covered=0 cells=64 tile=4 "
            "order=open-by-tile batch=7 seed=431527");
  EXPECT_EQ(without_isa(random_structure(5).name), "wide tree=RANDOM+SPFH@paper area=3 batch=16 seed=752307");
  EXPECT_EQ(without_isa(random_structure(20).name),
            "wide tree=VISIBLE+LSPH@paper reinserted=1 area=4 leaf=3 batch=17 unpruned=1 seed=19397 by_own_measure=1");
}

TEST(Draws, OfMeshesAndRays) {
  const NamedMesh family = random_family_mesh(500, 2);
  const TriangleMesh& mesh = family.mesh;
  EXPECT_EQ(family.name, "fan");
  EXPECT_EQ(fingerprint(mesh.vertices, mesh.triangles), 15443401810692060827u);
  EXPECT_EQ(fingerprint(aimed_rays(mesh, 500, 3)), 10941594090954635199u);
  EXPECT_EQ(fingerprint(extreme_rays(mesh, 500, 4)), 3663318286183623185u);
  EXPECT_EQ(fingerprint(rays_of_areas(mesh, areas_around(mesh, 5), 300, 6)), 8776733724438304158u);
  EXPECT_EQ(fingerprint(rays_from({1, 2, 3}, mesh, 100, 7)), 892069410283242087u);
  EXPECT_EQ(fingerprint(points_near(mesh, {}, 300, 8)), 7401841290308378653u);
  EXPECT_EQ(fingerprint(points_near(mesh, {0, 1, 0.5f}, 300, 9)), 4613684083284197298u);
}

TEST(Draws, OfRounds) {
  VerifyOptions options;
  options.seed = 5;
  std::vector<std::string> names;
  for (uint64_t number = 0; number < 4; ++number) {
    const verification::Round round = verification::make_round(options, number);
    names.push_back(round.scene.name + " " + std::to_string(round.scene.mesh->triangle_count()) + " " +
                    std::to_string(round.ray_count()) + " " + without_isa(round.structures.at(1)));
  }
  EXPECT_EQ(
      names,
      (std::vector<std::string>{
          "closed_box_slivers_scaled_1e1_moved_1e6 382 7403 wide tree=VISIBLE+LSPH@subset area=2 counted=1 seed=244647",
          "closed_box_slivers 16 39998 accelerator tree=RANDOM+ALL@sweep local=PAH+ROBIN@spatial area=15 tile=4 "
          "order=by-cell batch=7 seed=756076 reinserted_local=1",
          "layers 26 49996 wide tree=PAH-UNCULLED+LSPH@spatial for_wide=1 leaf=1 batch=1 counted=1 seed=510950 "
          "wide_measure=VISIBLE",
          "huge 97 27206 frame area=11 frame=projective of_area=1 spatial=0 seed=464905"}));
}

}  // namespace
}  // namespace raygrain::test
