// The viewer's page: what is put into it can be taken out again, bit for bit.
#include "raygrain/view.h"

#include <bit>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"

namespace raygrain {
namespace {

constexpr const char* kPage = "<a>@RAYGRAIN_VIEW@</a><b>@RAYGRAIN_BLOBS@</b>";

std::vector<uint8_t> from_base64(std::string_view text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t word = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<uint8_t>(word >> bits));
  }
  return bytes;
}

/// A page taken apart.
struct OpenedPage {
  nlohmann::json data;
  std::string lines;

  explicit OpenedPage(const std::string& page) {
    const auto between = [&](const std::string& tag) {
      const size_t start = page.find('<' + tag + '>') + 3;
      return page.substr(start, page.find("</" + tag + '>') - start);
    };
    data = nlohmann::json::parse(between("a"));
    lines = between("b");
  }

  /// An array as it was before differences were taken.
  std::vector<uint32_t> words(const nlohmann::json& blob, const std::string& name, int planes) const {
    const std::vector<uint8_t> packed =
        from_base64(std::string_view(lines).substr(blob["start"].get<size_t>(), blob["length"].get<size_t>()));
    std::vector<uint8_t> bytes(blob["bytes"].get<size_t>());
    uLongf size = bytes.size();
    EXPECT_EQ(::uncompress(bytes.data(), &size, packed.data(), packed.size()), Z_OK);
    const auto offset = blob["arrays"][name]["offset"].get<size_t>(),
               count = blob["arrays"][name]["count"].get<size_t>();
    std::vector<uint32_t> result(count, 0);
    for (int plane = 0; plane < planes; ++plane)
      for (size_t i = 0; i < count; ++i)
        result[i] |= uint32_t{bytes[offset + static_cast<size_t>(plane) * count + i]} << (8 * plane);
    return result;
  }
  std::vector<uint32_t> whole(const nlohmann::json& blob, const std::string& name) const {
    std::vector<uint32_t> result = words(blob, name, 4);
    uint32_t before = 0;
    for (uint32_t& word : result) before = word = before + (word >> 1 ^ (0u - (word & 1)));
    return result;
  }
};

struct Fixture {
  Scene scene = generate_scene({.kind = "city", .size = 2, .seed = 1});
  std::vector<ViewTree> trees;

  explicit Fixture(const char* recipe) {
    const Registry registry = default_registry();
    LocalTree local = build_local_tree(scene.mesh, scene.areas[0], parse_recipe(recipe, registry), registry);
    ViewTree tree;
    tree.recipe = recipe;
    tree.area = 0;
    tree.tree = local.tree;
    tree.log = local.log;
    tree.measure = local.measure;
    trees.push_back(tree);
  }
  std::string page(const std::string& text = kPage) const { return view_page(scene, trees, {}, text, "viewer.html"); }
};

TEST(View, HoldsMeshAndTreesBitForBit) {
  const Fixture fixture("PAH+ALL");
  const OpenedPage page(fixture.page());
  const TriangleMesh& mesh = fixture.scene.mesh;
  const std::vector<uint32_t> x = page.words(page.data["mesh"], "x", 4);
  ASSERT_EQ(x.size(), mesh.vertices.size());
  for (size_t i = 0; i < x.size(); ++i) ASSERT_EQ(x[i], std::bit_cast<uint32_t>(mesh.vertices[i].x)) << i;
  const std::vector<uint32_t> corners = page.whole(page.data["mesh"], "corners");
  ASSERT_EQ(corners.size(), 3 * mesh.triangle_count());
  for (size_t i = 0; i < corners.size(); ++i) ASSERT_EQ(corners[i], mesh.triangles[i / 3][i % 3]) << i;

  const Bvh& bvh = *fixture.trees[0].tree;
  const nlohmann::json& blob = page.data["trees"][0]["data"];
  EXPECT_EQ(page.whole(blob, "prims"), bvh.prims);
  EXPECT_FALSE(blob["arrays"].contains("boxes")) << "boxes that can be computed are not stored";
  const std::vector<uint32_t> counts = page.whole(blob, "count"), children = page.whole(blob, "children"),
                              starts = page.whole(blob, "starts");
  size_t inner = 0, leaf = 0;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    ASSERT_EQ(counts[i], bvh.nodes[i].count) << i;
    ASSERT_EQ(counts[i] ? starts[leaf++] : children[inner++], bvh.nodes[i].first) << i;
  }
}

TEST(View, StoresBoxesThatCannotBeComputed) {
  const Fixture fixture("PAH+ALL@spatial");
  const OpenedPage page(fixture.page());
  const Bvh& bvh = *fixture.trees[0].tree;
  ASSERT_TRUE(bvh.split_references);
  const std::vector<uint32_t> boxes = page.words(page.data["trees"][0]["data"], "boxes", 4);
  ASSERT_EQ(boxes.size(), 6 * bvh.nodes.size());
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    EXPECT_EQ(boxes[6 * i], std::bit_cast<uint32_t>(bvh.nodes[i].bounds.lo.x));
    EXPECT_EQ(boxes[6 * i + 5], std::bit_cast<uint32_t>(bvh.nodes[i].bounds.hi.z));
  }
}

TEST(View, RoundsMeasuresToSixteenBits) {
  const Fixture fixture("SAH+LSPH");
  const OpenedPage page(fixture.page());
  const Bvh& bvh = *fixture.trees[0].tree;
  const std::vector<uint32_t> measures = page.words(page.data["trees"][0]["data"], "measure", 3);
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const float exact = fixture.trees[0].measure(bvh.nodes[i].bounds);
    EXPECT_NEAR(std::bit_cast<float>(measures[i] << 8), exact, exact * 0x1p-15f) << i;
  }
}

TEST(View, IsTheSameForTheSameInput) {
  EXPECT_EQ(Fixture("PAH+SPFH").page(), Fixture("PAH+SPFH").page());
}

TEST(View, KeepsNamesOutOfTheMarkup) {
  Fixture fixture("SAH+ALL");
  fixture.scene.name = "</script><script>alert(1)</script> @RAYGRAIN_BLOBS@ \xff";
  fixture.scene.areas[0].name = "<!--";
  const std::string page = fixture.page();
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  EXPECT_EQ(page.find("<!--"), std::string::npos);
  EXPECT_EQ(OpenedPage(page).data["areas"][0]["name"], "<!--");
}

TEST(View, RefusesWhatIsNoPageAndTreesOfNowhere) {
  Fixture fixture("SAH+ALL");
  for (const char* text : {"", "@RAYGRAIN_VIEW@", "@RAYGRAIN_BLOBS@ @RAYGRAIN_VIEW@ @RAYGRAIN_VIEW@"}) {
    try {
      fixture.page(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kMalformed) << text;
      EXPECT_EQ(error.where, "viewer.html");
    }
  }
  fixture.trees[0].area = 7;
  EXPECT_THROW(fixture.page(), Error);
  fixture.trees[0].area = 0;
  fixture.trees[0].tree = std::make_shared<const Bvh>();
  EXPECT_THROW(fixture.page(), Error);
}

}  // namespace
}  // namespace raygrain
