// Structures under verification: drawn at random, and made again from their names.
#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/verify.h"
#include "raygrain/wide.h"

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
                                    "tree=SAMPLED+ALL"};
  for (const Isa isa : supported_isas())
    if (isa != Isa::kScalar) expected.push_back(std::string("isa=") + name(isa));
  for (const std::string& word : expected) EXPECT_EQ(words.count(word), 1u) << word;
}

}  // namespace
}  // namespace raygrain
