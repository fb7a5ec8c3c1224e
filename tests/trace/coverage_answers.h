// What coverages answer beside what brute force answers.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/coverage.h"
#include "raygrain/trace.h"

#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain::test {

/// Answered and hit rays over all tests of a kind: a test that answers nothing proves nothing.
struct Tally {
  size_t asked = 0, answered = 0, hits = 0;
};

/// Which rays were answered: all but `rest`, which is ascending and without doubles.
inline std::vector<bool> answered(size_t count, const std::vector<uint32_t>& rest) {
  std::vector<bool> is_answered(count, true);
  EXPECT_TRUE(std::ranges::is_sorted(rest));
  EXPECT_EQ(std::ranges::adjacent_find(rest), rest.end());
  for (const uint32_t i : rest) is_answered[i] = false;
  return is_answered;
}

inline std::vector<uint8_t> oracle_flags(const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  std::vector<uint8_t> flags;
  for (const Ray& ray : rays) flags.push_back(occluded_reference(mesh, ray));
  return flags;
}
inline std::vector<Hit> oracle_hits(const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(intersect_reference(mesh, ray));
  return hits;
}

inline void expect_flags(const std::vector<uint8_t>& expected, const std::vector<uint8_t>& flags,
                         const std::vector<uint32_t>& rest, Tally& tally) {
  const std::vector<bool> is_answered = answered(expected.size(), rest);
  for (size_t i = 0; i < expected.size(); ++i) {
    ++tally.asked;
    if (!is_answered[i]) continue;
    ++tally.answered;
    tally.hits += flags[i];
    ASSERT_EQ(flags[i], expected[i]) << "ray " << i;
  }
}

inline void expect_hits(const std::vector<Hit>& expected, const std::vector<Hit>& hits,
                        const std::vector<uint32_t>& rest, Tally& tally) {
  const std::vector<bool> is_answered = answered(expected.size(), rest);
  for (size_t i = 0; i < expected.size(); ++i) {
    ++tally.asked;
    if (!is_answered[i]) continue;
    ++tally.answered;
    tally.hits += is_hit(hits[i]);
    ASSERT_TRUE(same_bits(hits[i], expected[i])) << "ray " << i;
  }
}

/// Single rays that are answered get the same answer; most are where the batch answers.
inline void expect_same_singly(const Coverage& coverage, const std::vector<Ray>& rays,
                               const std::vector<uint8_t>& flags, const std::vector<uint32_t>& rest) {
  const std::vector<bool> is_answered = answered(rays.size(), rest);
  for (size_t i = 0; i < rays.size(); ++i) {
    const std::optional<bool> flag = coverage.occluded(rays[i]);
    if (flag && is_answered[i]) {
      ASSERT_EQ(*flag, flags[i] != 0) << "ray " << i;
    }
  }
}
inline void expect_same_singly(const Coverage& coverage, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                               const std::vector<uint32_t>& rest) {
  const std::vector<bool> is_answered = answered(rays.size(), rest);
  for (size_t i = 0; i < rays.size(); ++i) {
    const std::optional<Hit> hit = coverage.intersect(rays[i]);
    if (hit && is_answered[i]) {
      ASSERT_TRUE(same_bits(*hit, hits[i])) << "ray " << i;
    }
  }
}

/// Scenes of up to 2^60: around greater ones there is no finite area.
inline bool has_areas(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  for (const Vec3 p : {box.lo, box.hi})
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) < 0x1p60f)) return false;
  return true;
}

template <class Body>
void for_families(uint64_t seeds, const Body& body) {
  for (uint64_t seed = 0; seed < seed_count(seeds); ++seed)
    for (const NamedMesh& family : mesh_families(seed)) {
      if (family.mesh.triangles.empty() || !has_areas(family.mesh)) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      body(std::make_shared<const TriangleMesh>(family.mesh), seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace raygrain::test
