#include "study/hit_check.h"

#include <atomic>

#include <gtest/gtest.h>

#include "geometry/same_bits.h"
#include "study/progress.h"

namespace raygrain {
namespace {

TEST(HitCheck, EveryBitCounts) {
  const Hit hit{1.5f, 0.25f, 0.5f, 7};
  EXPECT_TRUE(same_bits(hit, hit));
  EXPECT_TRUE(same_bits(Hit{}, Hit{}));
  EXPECT_FALSE(same_bits(hit, {std::nextafter(1.5f, 2.0f), 0.25f, 0.5f, 7}));
  EXPECT_FALSE(same_bits(hit, {1.5f, std::nextafter(0.25f, 0.0f), 0.5f, 7}));
  EXPECT_FALSE(same_bits(hit, {1.5f, 0.25f, 0.5000001f, 7}));
  EXPECT_FALSE(same_bits(hit, {1.5f, 0.25f, 0.5f, 6}));
  EXPECT_FALSE(same_bits({0.0f, 0, 0, 1}, {-0.0f, 0, 0, 1}));  // equal numbers, different bits
}

TEST(HitCheck, CountsRaysNotDifferences) {
  const Hit a{1, 0, 0, 1}, b{2, 0, 0, 2};
  const std::vector<Hit> hits{a, a, b, {}};
  const std::vector<std::vector<Hit>> same{hits, hits};
  EXPECT_EQ(count_mismatches(hits, same), 0u);
  const std::vector<std::vector<Hit>> one_list_differs{hits, {a, b, b, {}}};
  EXPECT_EQ(count_mismatches(hits, one_list_differs), 1u);
  const std::vector<std::vector<Hit>> both_differ{{b, a, b, {}}, {b, a, b, a}};
  EXPECT_EQ(count_mismatches(hits, both_differ), 2u);
}

TEST(HitCheck, FindsHitsInOrderForAnyThreads) {
  std::vector<Ray> rays(1000);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].tmin = static_cast<float>(i);
  for (const unsigned threads : {1u, 2u, 8u}) {
    const auto hits = find_hits(
        rays,
        [](const Ray& ray) {
          return Hit{ray.tmin, 0, 0, 1};
        },
        threads);
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i].t, rays[i].tmin);
  }
}

TEST(HitCheck, TellsPartsOfSlowSearches) {
  std::vector<Ray> rays(1000);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].tmin = static_cast<float>(i);
  std::vector<double> parts;
  const auto search = [](const Ray& ray) { return Hit{ray.tmin, 0, 0, 1}; };
  const auto hits = find_hits(rays, search, 2, [&](double part) { parts.push_back(part); });
  EXPECT_EQ(parts, (std::vector<double>{0, 0.256, 0.512, 0.768}));
  for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i].t, rays[i].tmin);
}

TEST(Progress, AdvancesWithinAStep) {
  std::vector<double> done;
  const Progress::Callback callback = [&](const std::string&, double d) {
    done.push_back(d);
    return true;
  };
  Progress progress(callback, 2);
  progress.begin("a");
  progress.advance(0.5);
  progress.begin("b");
  progress.finish();
  EXPECT_EQ(done, (std::vector<double>{0, 0.25, 0.5, 1}));
}

TEST(Progress, CountsUpAndCancels) {
  std::vector<double> done;
  const Progress::Callback callback = [&](const std::string&, double d) {
    done.push_back(d);
    return d < 0.5;
  };
  Progress progress(callback, 4);
  progress.begin("a");
  progress.begin("b");
  try {
    progress.begin("c");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kCancelled);
    EXPECT_EQ(error.where, "c");
  }
  EXPECT_EQ(done, (std::vector<double>{0, 0.25, 0.5}));
}

}  // namespace
}  // namespace raygrain
