// Trees saved and loaded: the same bytes back; damaged, foreign and unsound files are errors.
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/mesh.h"

#include "base/random.h"
#include "io/crc32.h"
#include "mesh_files.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain {
namespace {

Bvh tree_of(const TriangleMesh& mesh, bool spatial) {
  BuildOptions options;
  options.clip = [&mesh](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh, i, box); };
  return (spatial ? build_spatial : build_binned)(triangle_bounds(mesh), triangle_centroids(mesh), options, nullptr);
}

class TreeFile : public testing::Test {
 protected:
  std::string path() const { return folder_.file("tree.rgt"); }

  ErrorCode code_of(const std::string& bytes) const {
    test::put_file(path(), bytes);
    try {
      load_tree(path());
    } catch (const Error& error) {
      EXPECT_NE(error.where.find("tree.rgt"), std::string::npos);
      return error.code;
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::kCancelled;
  }

  std::string saved(const Bvh& bvh) const {
    save_tree(bvh, path());
    return test::get_file(path());
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(Crc32, IsThatOfTheStandard) {
  EXPECT_EQ(crc32("123456789"), 0xcbf43926u);
  EXPECT_EQ(crc32(""), 0u);
}

TEST_F(TreeFile, ComesBackByteForByte) {
  for (const test::NamedMesh& mesh : test::mesh_families(2))
    for (const bool spatial : {false, true}) {
      SCOPED_TRACE(mesh.name);
      const Bvh bvh = tree_of(mesh.mesh, spatial);
      save_tree(bvh, path());
      const Bvh back = load_tree(path());
      ASSERT_EQ(back.nodes.size(), bvh.nodes.size());
      if (!bvh.nodes.empty()) {
        EXPECT_EQ(std::memcmp(back.nodes.data(), bvh.nodes.data(), bvh.nodes.size() * sizeof(Bvh::Node)), 0);
      }
      EXPECT_EQ(back.prims, bvh.prims);
      EXPECT_EQ(back.split_references, bvh.split_references);
    }
}

TEST_F(TreeFile, PartsOfAPrimitiveMayLieApart) {
  Bvh bvh;
  bvh.split_references = true;
  bvh.nodes = {{{{0, 0, 0}, {9, 1, 1}}, 1, 0}, {{{0, 0, 0}, {1, 1, 1}}, 0, 1}, {{{8, 0, 0}, {9, 1, 1}}, 1, 2}};
  bvh.prims = {0, 0, 1};
  save_tree(bvh, path());
  EXPECT_EQ(load_tree(path()).prims, bvh.prims);
}

TEST_F(TreeFile, OfAnAreaMayHaveAnyIds) {
  Bvh bvh = tree_of(test::mesh_families(1)[0].mesh, false);
  for (uint32_t& prim : bvh.prims) prim = 4'000'000'000u - 7 * prim;
  save_tree(bvh, path());
  EXPECT_EQ(load_tree(path()).prims, bvh.prims);
}

TEST_F(TreeFile, EveryTruncationIsAnError) {
  const std::string bytes = saved(tree_of(test::mesh_families(1)[0].mesh, false));
  for (size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 7)
    EXPECT_EQ(code_of(bytes.substr(0, size)), ErrorCode::kMalformed) << size;
  EXPECT_EQ(code_of(bytes + '\0'), ErrorCode::kMalformed);
}

TEST_F(TreeFile, EveryFlippedByteIsAnError) {
  const std::string bytes = saved(tree_of(test::mesh_families(1)[0].mesh, true));
  Random random(1);
  for (size_t at = 0; at < bytes.size(); at += at < 100 ? 1 : 1 + random.below(9)) {
    std::string bad = bytes;
    bad[at] = static_cast<char>(bad[at] ^ static_cast<char>(1 + random.below(255)));
    const ErrorCode code = code_of(bad);
    EXPECT_TRUE(code == ErrorCode::kMalformed || code == ErrorCode::kUnsupported) << at;
  }
}

TEST_F(TreeFile, UnsoundTreesWithARightChecksumAreErrors) {
  // Files that only a hostile writer makes: random trees, saved as they are.
  const Bvh good = tree_of(test::mesh_families(1)[0].mesh, false);
  ASSERT_GT(good.nodes.size(), 10u);
  size_t refused = 0;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    Bvh bad = good;
    Bvh::Node& node = bad.nodes[random.below(bad.nodes.size())];
    const auto any = static_cast<uint32_t>(random.below(4) ? random.below(2 * bad.nodes.size()) : random.next());
    (random.below(2) ? node.first : node.count) = any;
    bad.split_references = random.below(2);
    save_tree(bad, path());
    try {
      load_tree(path());
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kMalformed);
      ++refused;
    }
  }
  EXPECT_GT(refused, 400u);
}

TEST_F(TreeFile, WhatIsNotThereIsAnError) {
  try {
    load_tree(path() + ".none");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kNotFound);
  }
}

}  // namespace
}  // namespace raygrain
