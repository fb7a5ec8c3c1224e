#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "raygrain/io.h"

#include "base/random.h"
#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using nlohmann::json;

json saved(const Bvh& bvh, const std::string& info) {
  const test::TemporaryFolder folder;
  save_tree_json(bvh, info, folder.file("tree.json"));
  return json::parse(test::get_file(folder.file("tree.json")));
}

TEST(TreeJson, EmptyTree) {
  const json tree = saved({}, "");
  EXPECT_EQ(tree["format"], "raygrain-tree");
  EXPECT_EQ(tree["version"], 1);
  EXPECT_EQ(tree["info"], json::object());
  EXPECT_EQ(tree["nodes"], json::array());
  EXPECT_EQ(tree["prims"], json::array());
}

TEST(TreeJson, NodesComeBack) {
  Random random(3);
  Bvh bvh;
  for (uint32_t i = 0; i < 100; ++i) {
    Bvh::Node node{{}, i, i % 3};
    for (int corner = 0; corner < 2; ++corner)
      node.bounds.extend(
          Vec3{static_cast<float>(random.uniform(-1e9, 1e9)), static_cast<float>(random.uniform()), 0.1f});
    bvh.nodes.push_back(node);
    bvh.prims.push_back(99 - i);
  }
  bvh.nodes[5].bounds = {};
  const json tree = saved(bvh, R"({"recipe": "SAH", "cost": 1.5})");
  EXPECT_EQ(tree["info"]["recipe"], "SAH");
  EXPECT_EQ(tree["prims"].get<std::vector<uint32_t>>(), bvh.prims);
  ASSERT_EQ(tree["nodes"].size(), bvh.nodes.size());
  EXPECT_TRUE(tree["nodes"][5][0].is_null());
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const json& row = tree["nodes"][i];
    ASSERT_EQ(row.size(), tree["node_fields"].size());
    for (int axis = 0; axis < 3 && i != 5; ++axis) {
      EXPECT_EQ(row[static_cast<size_t>(axis)].get<float>(), bvh.nodes[i].bounds.lo[axis]);
      EXPECT_EQ(row[static_cast<size_t>(axis) + 3].get<float>(), bvh.nodes[i].bounds.hi[axis]);
    }
    EXPECT_EQ(row[6], bvh.nodes[i].first);
    EXPECT_EQ(row[7], bvh.nodes[i].count);
  }
}

}  // namespace
}  // namespace raygrain
