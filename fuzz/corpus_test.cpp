// Every file of the corpora through its target: what fuzzers once found stays mended, with every compiler.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "support/mesh_families.h"
#include "targets.h"

namespace raygrain::fuzz {
namespace {

std::vector<uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> files_of(const std::string& target) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(RAYGRAIN_FUZZ_CORPUS "/" + target))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, HoldsNoFinding) {
  const Target& target = GetParam();
  const std::vector<std::filesystem::path> paths = files_of(target.name);
  ASSERT_FALSE(paths.empty());
  for (const std::filesystem::path& path : paths) {
    const std::vector<uint8_t> bytes = bytes_of(path);
    std::printf("%s\n", path.c_str());  // where a crash ends the program
    EXPECT_NO_THROW(target.run(bytes)) << path;
    // A buffer of exactly that size: one byte too far is a crash under a sanitizer.
    for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 16) {
      const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_NO_THROW(target.run(cut)) << path << ", the first " << size << " bytes";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& row) { return std::string(row.param.name); });

/// Without coverage to guide it, but a hundred times as fast as under sanitizers.
TEST(RandomBytes, HoldNoFinding) {
  for (const auto run : {traversal, structure})
    for (uint64_t seed = 1; seed <= test::seed_count(400); ++seed) {
      Random random(seed);
      std::vector<uint8_t> bytes(random.below(700));
      for (uint8_t& byte : bytes)  // most near 100, which readers of coordinates take for little multiples of 1/8
        byte = static_cast<uint8_t>(random.below(3) == 0 ? random.below(256) : 90 + random.below(20));
      EXPECT_NO_THROW(run(bytes)) << "seed " << seed;
    }
}

}  // namespace
}  // namespace raygrain::fuzz
