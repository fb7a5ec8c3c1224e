// What may be chosen about a wide tree: its options, its instruction set, the threads that write it.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/error.h"
#include "raygrain/wide.h"

#include "support/mesh_families.h"
#include "support/triangle_soup.h"
#include "trace/wide_tree.h"

namespace raygrain {
namespace {

Bvh binned_tree(const TriangleMesh& mesh) {
  BuildOptions options;
  options.merge_leaves = true;
  return build_binned(triangle_bounds(mesh), triangle_centroids(mesh), options);
}

TEST(Wide, RefusesBadOptions) {
  const TriangleMesh mesh = test::mesh_families(1).front().mesh;
  const Bvh binary = binned_tree(mesh);
  const auto code_of = [&](const WideOptions& options) {
    try {
      WideBvh(binary, mesh, options);
    } catch (const Error& error) {
      return std::string(name(error.code));
    }
    return std::string("none");
  };
  EXPECT_EQ(code_of({}), "none");
  EXPECT_EQ(code_of({.max_leaf_size = 0}), "usage");
  EXPECT_EQ(code_of({.max_leaf_size = 9}), "usage");
  EXPECT_EQ(code_of({.costs = {.leaf = -1}}), "usage");
  EXPECT_EQ(code_of({.measure = [](const Bounds&) { return -1.0f; }}), "bad_heuristic");
  std::vector<Hit> too_few(1);
  EXPECT_THROW(WideBvh(binary, mesh).intersect(std::vector<Ray>(2), too_few), Error);
  const std::vector<Isa> isas = supported_isas();
  for (const Isa isa : {Isa::kSse4, Isa::kAvx2, Isa::kAvx512, Isa::kNeon})
    EXPECT_EQ(code_of({.isa = isa}), std::ranges::count(isas, isa) == 1 ? "none" : "usage") << name(isa);
}

TEST(Isa, TheEnvironmentChooses) {
  const char* before = std::getenv("RAYGRAIN_ISA");
  const std::string kept = before != nullptr ? before : "";
  ASSERT_EQ(supported_isas().front(), Isa::kScalar);
  for (const Isa isa : supported_isas()) {
    setenv("RAYGRAIN_ISA", name(isa), 1);
    EXPECT_EQ(default_isa(), isa);
    EXPECT_EQ(WideBvh(Bvh{}, {}).isa(), isa);
  }
  for (const char* wrong : {"avx", "AVX2", "fast", " "}) {
    setenv("RAYGRAIN_ISA", wrong, 1);
    EXPECT_THROW(default_isa(), Error) << wrong;
    EXPECT_THROW(WideBvh(Bvh{}, {}), Error) << wrong;
  }
  setenv("RAYGRAIN_ISA", "", 1);
  EXPECT_EQ(default_isa(), supported_isas().back());
  before != nullptr ? setenv("RAYGRAIN_ISA", kept.c_str(), 1) : unsetenv("RAYGRAIN_ISA");
  EXPECT_NO_THROW(WideBvh());
}

TEST(Wide, ThreadsDecideNoByte) {
  const TriangleMesh mesh = test::triangle_soup(20000, 3);
  const Bvh binary = binned_tree(mesh);
  const WideTree one = collapse(binary, mesh, {.threads = 1});
  ASSERT_GT(one.leaves, 4000u) << "several threads must share the work";
  for (const unsigned threads : {2u, 8u}) {
    const WideTree several = collapse(binary, mesh, {.threads = threads});
    ASSERT_EQ(several.memory.size(), one.memory.size());
    EXPECT_EQ(std::memcmp(several.memory.data(), one.memory.data(), one.memory.size()), 0) << threads << " threads";
  }
}

}  // namespace
}  // namespace raygrain
