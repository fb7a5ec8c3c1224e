#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/scene.h"

#include "support/fingerprint.h"

namespace raygrain {
namespace {

void expect_triangle(const TriangleMesh& mesh, size_t triangle, const std::array<Vec3d, 3>& expected) {
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      const double value = expected[static_cast<size_t>(corner)][axis];
      // The published numbers have six digits.
      EXPECT_NEAR(mesh.vertex(triangle, corner)[axis], value,
                  0.5001e-5 * std::max(1.0, std::pow(10, std::floor(std::log10(std::abs(value))))))
          << "triangle " << triangle << ", corner " << corner << ", axis " << axis;
    }
}

std::string usage_error(const std::string& text) {
  try {
    generate_scene(parse_procedural(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kUsage) << text;
    return error.what();
  }
  ADD_FAILURE() << "no error for " << text;
  return {};
}

// Check vectors of the scenes of "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies Construction in Ray
// Tracing" (2024).
TEST(ProceduralRandom, HundredIsThePapers) {
  const TriangleMesh mesh = generate_scene({"random100", 0, 1}).mesh;
  ASSERT_EQ(mesh.triangle_count(), 100u);
  expect_triangle(mesh, 0, {{{9.97185, 9.32557, 1.28124}, {10.9699, 8.79775, 1.07441}, {10.7458, 9.13724, 1.94548}}});
  expect_triangle(mesh, 99, {{{9.72104, 1.4884, 5.99692}, {9.5447, 1.96409, 6.27}, {10.3866, 2.31244, 5.72684}}});
}

TEST(ProceduralRandom, ThousandIsDrawnAfterTheHundred) {
  const TriangleMesh mesh = generate_scene({"random1000", 0, 1}).mesh;
  ASSERT_EQ(mesh.triangle_count(), 1000u);
  expect_triangle(mesh, 0, {{{4.36192, 5.11046, 9.7172}, {3.36703, 4.24014, 10.4102}, {4.25799, 4.77214, 10.7125}}});
  expect_triangle(mesh, 999, {{{7.24814, 2.47334, 7.78362}, {8.0534, 1.5455, 8.43034}, {9.0418, 0.994537, 9.01601}}});
}

struct Expected {
  ProceduralOptions options;
  size_t least, most;  // triangles
};

TEST(Procedural, SizesGiveTheDocumentedCounts) {
  const Expected table[] = {
      {{"city", 0, 1}, 10000, 40000},    {{"city", 15, 1}, 80000, 130000},      {{"city", 48, 1}, 900000, 1200000},
      {{"forest", 0, 1}, 20000, 40000},  {{"forest", 16, 1}, 90000, 120000},    {{"forest", 49, 1}, 900000, 1100000},
      {{"terrain", 0, 1}, 20000, 20000}, {{"terrain", 224, 1}, 100352, 100352}, {{"terrain", 708, 1}, 1002528, 1002528},
      {{"city", 1, 1}, 100, 5000},       {{"forest", 1, 1}, 50, 2000},          {{"terrain", 1, 1}, 2, 2},
  };
  for (const Expected& row : table) {
    SCOPED_TRACE(row.options.kind + " " + std::to_string(row.options.size));
    const TriangleMesh mesh = generate_scene(row.options).mesh;
    EXPECT_GE(mesh.triangle_count(), row.least);
    EXPECT_LE(mesh.triangle_count(), row.most);
    EXPECT_NO_THROW(validate(mesh, "procedural"));
  }
}

TEST(Procedural, TrianglesHaveAreaAndVaryInSize) {
  for (const char* kind : {"city", "forest", "terrain"})
    for (uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::string(kind) + " seed " + std::to_string(seed));
      const TriangleMesh mesh = generate_scene({kind, 0, seed}).mesh;
      double least = INFINITY, greatest = 0;
      for (size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Vec3d a = to_double(mesh.vertex(i, 0)), b = to_double(mesh.vertex(i, 1)),
                    c = to_double(mesh.vertex(i, 2));
        const double area = length(cross(b - a, c - a)) / 2;
        least = std::min(least, area);
        greatest = std::max(greatest, area);
      }
      EXPECT_GT(least, 0);
      EXPECT_GT(greatest, std::string(kind) == "terrain" ? least * 1.3 : least * 100);
    }
}

// The grounds look up, so that pictures can shade by facing.
TEST(Procedural, GroundFacesUp) {
  for (const char* kind : {"city", "forest", "terrain"}) {
    SCOPED_TRACE(kind);
    const TriangleMesh mesh = generate_scene({kind, 2, 1}).mesh;
    const Vec3 a = mesh.vertex(0, 0);
    EXPECT_GT(cross(mesh.vertex(0, 1) - a, mesh.vertex(0, 2) - a).y, 0);
  }
}

TEST(Procedural, SameOptionsGiveTheSameBytes) {
  // Literal, so that another machine, compiler or library that gives other bytes is found out.
  const std::pair<ProceduralOptions, uint64_t> table[] = {
      {{"city", 5, 1}, 0xeffa97e4d94b8384u},      {{"city", 5, 2}, 0x32e13499a7d136c2u},
      {{"forest", 3, 1}, 0x53e39d0e722e4685u},    {{"forest", 3, 2}, 0x6bd6c66cfb57dfa1u},
      {{"terrain", 40, 1}, 0xea273fe4d1166905u},  {{"terrain", 40, 2}, 0x7f2a4ddc98f15180u},
      {{"random100", 0, 1}, 0xfbab600373f2a134u}, {{"random1000", 0, 1}, 0xc0c3753f50931872u},
  };
  std::set<uint64_t> seen;
  for (const auto& [options, expected] : table) {
    SCOPED_TRACE(options.kind + " size " + std::to_string(options.size) + " seed " + std::to_string(options.seed));
    const TriangleMesh mesh = generate_scene(options).mesh;
    const uint64_t found = test::fingerprint(mesh.vertices, mesh.triangles);
    EXPECT_EQ(found, expected) << std::hex << "0x" << found;
    EXPECT_TRUE(seen.insert(found).second) << "two scenes are alike";
  }
}

TEST(Procedural, EachHasOneSunAndItsRays) {
  for (const char* kind : {"city", "forest", "terrain", "random100", "random1000"}) {
    SCOPED_TRACE(kind);
    const Scene scene = generate_scene({kind, 0, 1});
    ASSERT_EQ(scene.areas.size(), 1u);
    EXPECT_EQ(scene.areas[0].name, "sun");
    EXPECT_TRUE(std::holds_alternative<PlaneArea>(scene.areas[0].shape));
    ASSERT_EQ(scene.ray_sets.size(), 1u);
    const AreaGeometry geometry(scene.areas[0]);
    EXPECT_TRUE(encloses(geometry.region(), mesh_bounds(scene.mesh)));
    const std::vector<Ray> rays = make_rays(scene.ray_sets[0], scene.mesh);
    ASSERT_EQ(rays.size(), 10000u);
    for (const Ray& ray : rays) ASSERT_TRUE(geometry.serves(ray));
  }
}

TEST(ParseProcedural, ReadsKindSizeAndSeed) {
  const ProceduralOptions whole = parse_procedural("procedural:forest?size=40&seed=18446744073709551615");
  EXPECT_EQ(whole.kind, "forest");
  EXPECT_EQ(whole.size, 40u);
  EXPECT_EQ(whole.seed, 18446744073709551615u);
  const ProceduralOptions bare = parse_procedural("procedural:city");
  EXPECT_EQ(bare.size, 0u);
  EXPECT_EQ(bare.seed, 1u);
  EXPECT_EQ(parse_procedural("procedural:terrain?seed=7").seed, 7u);
}

TEST(ParseProcedural, ReturnsWhatNamesTheScene) {
  for (const char* text : {"procedural:city?size=2&seed=3", "procedural:random100"})
    EXPECT_EQ(generate_scene(parse_procedural(text)).name, text);
}

TEST(ParseProcedural, RefusesWithAHint) {
  const std::pair<const char*, const char*> table[] = {
      {"procedural:cty", "Did you mean \"city\"?"},
      {"procedural:", "Known: city, forest"},
      {"procedural:ocean-of-glass", "Known: city, forest"},
      {"city", "procedural:KIND?size=N&seed=S"},
      {"", "procedural:KIND?size=N&seed=S"},
      {"procedural:city?size=0", "size is 0"},
      {"procedural:city?size=-4", "\"-4\""},
      {"procedural:city?size=4x", "\"4x\""},
      {"procedural:city?size=", "size is not a whole number"},
      {"procedural:city?size", "size is not a whole number"},
      {"procedural:city?size=99999999999", "size is not a whole number in range"},
      {"procedural:city?size=151", "Choose 1 to 150"},
      {"procedural:forest?size=151", "Choose 1 to 150"},
      {"procedural:terrain?size=7001", "Choose 1 to 7000"},
      {"procedural:city?sed=4", "Did you mean \"seed\"?"},
      {"procedural:city?seed=1.5", "\"1.5\""},
      {"procedural:random100?seed=4294967296", "seed 4294967296 is too large"},
      {"procedural:city?&size=3", "unknown parameter"},
      {"procedural:city?size=3&size=4", "size is there twice"},
      {"procedural:city?seed=1&size=4&seed=1", "seed is there twice"},
  };
  for (const auto& [text, fragment] : table) {
    SCOPED_TRACE(text);
    EXPECT_NE(usage_error(text).find(fragment), std::string::npos) << usage_error(text);
  }
}

}  // namespace
}  // namespace raygrain
