// Verification itself: it finds nothing wrong with raygrain, finds what is wrong with others, and makes that small.
#include "raygrain/verify.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/trace.h"

#include "support/shared.h"

namespace raygrain {
namespace {

uint64_t at_scale(uint64_t small, uint64_t normal, uint64_t full) {
  const char* variable = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string scale = variable != nullptr ? variable : "";
  return scale == "full" ? full : (scale == "small" ? small : normal);
}

std::string text_of(const VerifyResult& result) {
  std::string text = to_text(result.tally);
  for (const VerifyFailure& failure : result.failures)
    text += "\n" + failure.structure + ": " + failure.what + " " + failure.path;
  return text;
}

TEST(Verify, FindsNothingWrong) {
  VerifyOptions options;
  options.rays = at_scale(6'000, 250'000, 30'000'000);
  options.tests_per_scene = at_scale(20'000, 200'000, 1'000'000);
  options.structures_per_scene = 5;
  options.seed = 20;
  const VerifyResult result = verify(options);
  std::cout << text_of(result) << "\n";
  EXPECT_TRUE(result.tally.is_good()) << text_of(result);
  EXPECT_GE(result.tally.rays, options.rays);
  EXPECT_GT(result.tally.comparisons, 4 * options.rays);
  EXPECT_GT(result.tally.oracle_rays, options.rays / 2);
  EXPECT_GT(result.tally.hits, result.tally.rays / 5);
  EXPECT_GT(result.tally.inside_rays, result.tally.rays / 200);
  EXPECT_GT(result.tally.lines, result.tally.rays / 2000);
  uint64_t by_rays = 0;  // of every comparison, its kind of rays is known
  for (const auto& [aspect, count] : result.tally.comparisons_of) {
    EXPECT_GT(count, 0u) << aspect;
    if (aspect.find(" rays") != std::string::npos && aspect.find(',') != std::string::npos) by_rays += count;
  }
  EXPECT_EQ(by_rays, result.tally.comparisons);
  for (const char* aspect :
       {"wide, mixed rays", "coverage, rays to one point", "frame, rays of one direction",
        "accelerator, rays from one point", "builder spatial", "measure VISIBLE", "batches", "columns", "cones",
        "coverage: single", "coverage: batch", "accelerator: batch", "accelerators without local trees",
        "local trees, reinserted", "wide forms by VISIBLE", "density solid-angle", "measure SOLID"})
    EXPECT_EQ(result.tally.comparisons_of.count(aspect), 1u) << aspect;  // none is 0
}

/// Brute force, but for what `spoil` makes of it.
template <class Spoil>
RayStructure spoiled(const std::string& name, const Spoil& spoil) {
  return {name, [spoil](const VerifyScene& scene) {
            return [mesh = scene.mesh, spoil](const RayGroup& group, const RayAnswers& answers) {
              for (size_t i = 0; i < group.rays.size(); ++i) {
                answers.nearest[i] = intersect_reference(*mesh, group.rays[i]);
                answers.any[i] = is_hit(answers.nearest[i]);
                answers.told[i] = RayAnswers::kNearest | RayAnswers::kAny;
                spoil(*mesh, group, i, answers);
              }
            };
          }};
}

VerifyOptions about(const RayStructure& structure) {
  VerifyOptions options;
  options.rays = 3000;
  options.tests_per_scene = 100'000;
  options.structures_per_scene = 0;
  options.structures = {structure};
  options.most_failures = 2;
  return options;
}

size_t rays_of(const VerifyFailure& failure) {
  return std::get<std::vector<Ray>>(failure.scene.ray_sets.at(0).source).size();
}

TEST(Verify, AcceptsWhatIsRight) {
  const VerifyResult result =
      verify(about(spoiled("right", [](const TriangleMesh&, const RayGroup&, size_t, const RayAnswers&) {})));
  EXPECT_TRUE(result.tally.is_good()) << text_of(result);
  EXPECT_GE(result.tally.comparisons, 2 * result.tally.rays);
}

TEST(Verify, FindsAWrongHitMakesItSmallAndSavesIt) {
  // Forgets hits on triangles that stand upright along x: a defect that depends on the geometry only.
  const RayStructure forgetful =
      spoiled("forgetful", [](const TriangleMesh& mesh, const RayGroup&, size_t i, const RayAnswers& answers) {
        const Hit& hit = answers.nearest[i];
        if (!is_hit(hit)) return;
        const Vec3 a = mesh.vertex(hit.triangle, 0), b = mesh.vertex(hit.triangle, 1);
        if (a.x < b.x && a.y < b.y) answers.nearest[i] = {};
      });
  const test::TemporaryFolder folder;
  VerifyOptions options = about(forgetful);
  options.folder = folder.file("failures");
  const VerifyResult result = verify(options);
  EXPECT_FALSE(result.tally.is_good());
  EXPECT_GT(result.tally.differences, 10u);
  ASSERT_EQ(result.failures.size(), 2u);
  for (const VerifyFailure& failure : result.failures) {
    EXPECT_EQ(failure.structure, "forgetful");
    EXPECT_EQ(failure.scene.mesh.triangle_count(), 1u);
    EXPECT_EQ(failure.scene.mesh.vertices.size(), 3u);
    EXPECT_EQ(failure.scene.areas.size(), 0u);
    EXPECT_EQ(rays_of(failure), 1u);
    // The saved scene shows the same again, and is right for others.
    const Scene again = load_scene(failure.path);
    EXPECT_EQ(again.name, "forgetful");
    EXPECT_GT(verify_scene(again, std::vector{forgetful}).tally.differences, 0u);
    EXPECT_TRUE(verify_scene(again, std::vector{random_structure(1)}).tally.is_good());
  }
}

TEST(Verify, FindsTheLastBit) {
  const VerifyResult result =
      verify(about(spoiled("last bit", [](const TriangleMesh&, const RayGroup&, size_t i, const RayAnswers& answers) {
        Hit& hit = answers.nearest[i];
        if (is_hit(hit) && hit.triangle == 0 && hit.v > 0.5f) hit.v = std::nextafter(hit.v, 2.0f);
      })));
  ASSERT_FALSE(result.failures.empty());
  EXPECT_NE(result.failures[0].what.find("nearest hit"), std::string::npos);
  EXPECT_EQ(result.failures[0].scene.mesh.triangle_count(), 1u);
}

TEST(Verify, FindsAWrongYesOrNo) {
  const VerifyResult result =
      verify(about(spoiled("yes", [](const TriangleMesh&, const RayGroup& group, size_t i, const RayAnswers& answers) {
        if (group.kind == RayGroupKind::kTowards) answers.any[i] = 1;
      })));
  ASSERT_FALSE(result.failures.empty());
  EXPECT_NE(result.failures[0].what.find("any hit: 1"), std::string::npos) << result.failures[0].what;
}

TEST(Verify, KeepsTheRaysThatADefectNeeds) {
  // Answers a ray as the one before it, where that starts at smaller x: two rays are the least that shows it.
  const VerifyResult result = verify(
      about(spoiled("stale", [](const TriangleMesh&, const RayGroup& group, size_t i, const RayAnswers& answers) {
        if (i > 0 && group.rays[i - 1].origin.x < group.rays[i].origin.x && is_hit(answers.nearest[i - 1]))
          answers.nearest[i] = answers.nearest[i - 1];
      })));
  ASSERT_FALSE(result.failures.empty());
  for (const VerifyFailure& failure : result.failures) {
    EXPECT_EQ(rays_of(failure), 2u);
    EXPECT_LE(failure.scene.mesh.triangle_count(), 2u);
  }
}

TEST(Verify, CountsLeaksFromInside) {
  const VerifyResult result = verify(
      about(spoiled("leaky", [](const TriangleMesh&, const RayGroup& group, size_t i, const RayAnswers& answers) {
        if (group.must_hit && i % 2 == 0) answers.nearest[i] = {}, answers.any[i] = 0;
      })));
  EXPECT_GT(result.tally.leaks, 0u);
  EXPECT_GE(result.tally.leaks, result.tally.inside_rays / 2);
  EXPECT_LE(result.tally.leaks, result.tally.inside_rays / 2 + result.tally.scenes);
}

TEST(Verify, ReportsWhatThrows) {
  const RayStructure thrower{"thrower", [](const VerifyScene& scene) -> AnswerRays {
                               if (scene.mesh->triangle_count() > 4) throw Error(ErrorCode::kLimit, "tree", "too deep");
                               return {};
                             }};
  const VerifyResult result = verify(about(thrower));
  ASSERT_FALSE(result.failures.empty());
  EXPECT_NE(result.failures[0].what.find("too deep"), std::string::npos);
  EXPECT_EQ(result.failures[0].scene.mesh.triangle_count(), 5u);
}

TEST(Verify, IsTheSameOnAnyNumberOfThreads) {
  const RayStructure wrong =
      spoiled("wrong", [](const TriangleMesh&, const RayGroup&, size_t i, const RayAnswers& answers) {
        if (i % 97 == 96) answers.nearest[i].t = 5;
      });
  std::vector<std::string> texts;
  for (const unsigned threads : {1u, 3u}) {
    VerifyOptions options = about(wrong);
    options.threads = threads;
    options.structures_per_scene = 2;
    VerifyResult result = verify(options);
    result.tally.seconds = 0;
    texts.push_back(text_of(result));
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(Verify, EndsWhenItIsToldTo) {
  VerifyOptions options;
  options.rays = UINT64_MAX;
  options.tests_per_scene = 20'000;
  options.threads = 1;
  size_t asked = 0;
  options.stop = [&asked] { return ++asked > 10; };
  const VerifyResult result = verify(options);
  EXPECT_GT(result.tally.rays, 0u);
  EXPECT_LT(result.tally.scenes, 10u);
  options.stop = nullptr;
  options.seconds = 0;
  EXPECT_EQ(verify(options).tally.scenes, 0u);
}

TEST(Verify, TakesGivenScenesInTurns) {
  VerifyOptions options;
  options.rays = 25'000;
  options.tests_per_scene = 50'000;
  options.scenes = {generate_scene({"random100", 0, 1}), generate_scene({"terrain", 40, 1})};  // few and many triangles
  const VerifyResult result = verify(options);
  EXPECT_TRUE(result.tally.is_good()) << text_of(result);
  EXPECT_LT(result.tally.oracle_rays, result.tally.rays);
}

/// Whatever once went wrong, and a few scenes made by hand: see the folder.
TEST(Counterexamples, StayRight) {
  size_t scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / "tests/verify/scenes")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().string());
    ++scenes;
    const Scene scene = load_scene(entry.path().string());
    std::vector<RayStructure> structures{parse_structure(scene.name)};
    for (uint64_t seed = 0; seed < at_scale(20, 200, 2000); ++seed) structures.push_back(random_structure(seed));
    const VerifyResult result = verify_scene(scene, structures);
    EXPECT_TRUE(result.tally.is_good()) << text_of(result);
    EXPECT_GE(result.tally.comparisons, structures.size());
  }
  EXPECT_GE(scenes, 2u);
}

}  // namespace
}  // namespace raygrain
