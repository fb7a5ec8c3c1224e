// Rays to or from an eye are divided among the coverages about it.
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/area.h"
#include "raygrain/coverage.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "support/triangle_soup.h"

namespace raygrain::test {
namespace {

struct Divided {
  std::vector<std::vector<uint32_t>> lists;
  std::vector<uint32_t> rest{7};  // what is there stays
  bool operator==(const Divided&) const = default;
};

Divided divide(const std::vector<Coverage>& coverages, const std::vector<Vec3>& points, bool are_directions,
               unsigned threads) {
  std::vector<const Coverage*> asked;
  for (const Coverage& coverage : coverages) asked.push_back(&coverage);
  Divided divided;
  divided.lists = Coverage::divide(asked, points, are_directions, divided.rest, threads);
  return divided;
}

/// The list that each point is in, or how many lists there are for those of the rest. Fails where one is twice.
std::vector<size_t> owners(const Divided& divided, size_t points) {
  const size_t none = divided.lists.size();
  std::vector<size_t> owner(points, none + 1);
  const auto take = [&](std::span<const uint32_t> numbers, size_t list) {
    EXPECT_TRUE(std::ranges::is_sorted(numbers));
    for (const uint32_t number : numbers) {
      EXPECT_EQ(owner.at(number), none + 1) << number;
      owner.at(number) = list;
    }
  };
  for (size_t i = 0; i < none; ++i) take(divided.lists[i], i);
  take(std::span(divided.rest).subspan(1), none);
  EXPECT_EQ(std::ranges::count(owner, none + 1), 0);
  return owner;
}

// Five of six frusta, so that some rays are nobody's; more points than one task takes.
TEST(CoverageDivide, EveryPointIsOnceInTheListThatItHasAlone) {
  for (uint64_t seed = 0; seed < seed_count(2); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto mesh = std::make_shared<const TriangleMesh>(triangle_soup(200, seed));
    const Vec3 eye{50.1f, 49.8f, 50.3f};
    std::vector<InfluenceArea> areas = point_light_areas("lamp", eye, mesh_bounds(*mesh));
    areas.pop_back();
    const std::vector<Coverage> coverages = Coverage::of_areas(mesh, areas);
    for (const bool are_directions : {false, true}) {
      Random random(seed + 1);
      std::vector<Vec3> points;
      for (int i = 0; i < 50'003; ++i)
        points.push_back(to_float({random.uniform(-50, 150), random.uniform(-50, 150), random.uniform(-50, 150)}));
      const Divided divided = divide(coverages, points, are_directions, 1);
      for (const unsigned threads : {2u, 3u, 0u})
        EXPECT_EQ(divide(coverages, points, are_directions, threads), divided);
      const std::vector<size_t> owner = owners(divided, points.size());
      for (const std::vector<uint32_t>& list : divided.lists) EXPECT_GT(list.size(), 500u);
      EXPECT_GT(divided.rest.size(), 500u);
      for (const size_t i : {0u, 1u, 16'383u, 16'384u, 32'767u, 32'768u, 49'152u, 50'002u})
        EXPECT_EQ(owners(divide(coverages, {points[i]}, are_directions, 1), 1)[0], owner[i]) << i;
      for (size_t i = 0; i < points.size(); i += 97)
        EXPECT_EQ(owners(divide(coverages, {points[i]}, are_directions, 1), 1)[0], owner[i]) << i;
    }
  }
}

TEST(CoverageDivide, AnyNumberOfPointsAmongAnyNumberOfCoverages) {
  const auto mesh = std::make_shared<const TriangleMesh>(triangle_soup(50, 1));
  const Vec3 eye{50.1f, 49.8f, 50.3f};
  std::vector<Coverage> coverages = Coverage::of_areas(mesh, point_light_areas("lamp", eye, mesh_bounds(*mesh)));
  for (; !coverages.empty(); coverages.pop_back())
    for (const size_t count : {0u, 1u, 16'384u, 16'385u}) {
      const std::vector<Vec3> points(count, {90, 50, 50});
      const std::vector<size_t> owner = owners(divide(coverages, points, false, 2), count);
      EXPECT_EQ(std::ranges::count(owner, owner.empty() ? 0 : owner[0]), static_cast<std::ptrdiff_t>(count));
    }
}

}  // namespace
}  // namespace raygrain::test
