#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "raygrain/heuristics.h"
#include "raygrain/rays.h"
#include "raygrain/report.h"

#include "report/canvas.h"
#include "report/colour.h"
#include "report/depth_cue.h"

namespace raygrain {
namespace {

Colour pixel(const Image& image, uint32_t x, uint32_t y) {
  const uint8_t* p = &image.rgb[(size_t{y} * image.width + x) * 3];
  return {p[0], p[1], p[2]};
}

/// CIE lightness, 0 to 100.
double lightness(Colour c) {
  const auto linear = [](uint8_t channel) {
    const double v = channel / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

/// The quad [0, 4] x [0, 2] at z = 1 (near) with its right half at z = 3 (far), and a mesh without anything at y < 0.
TriangleMesh two_steps() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {2, 0, 3}, {4, 0, 3}, {4, 2, 3}, {2, 2, 3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return mesh;
}

Bvh one_leaf(const TriangleMesh& mesh) {
  Bvh bvh;
  bvh.nodes = {{mesh_bounds(mesh), 0, static_cast<uint32_t>(mesh.triangle_count())}};
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) bvh.prims.push_back(i);
  return bvh;
}

InfluenceArea view_along_z(float half_width, float half_height) {
  return {"view", PlaneArea{{2, 0, 0}, {0, 0, 1}, {0, 1, 0}, half_width, half_height, 10}};
}

TEST(HeatColour, LightnessRisesEvenly) {
  double before = lightness(heat_colour(0)), least = 100, most = 0;
  for (int i = 1; i <= 64; ++i) {
    const double now = lightness(heat_colour(i / 64.0));
    least = std::min(least, now - before);
    most = std::max(most, now - before);
    before = now;
  }
  EXPECT_GT(least, 0.6);
  EXPECT_LT(most, 2.5);
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
  EXPECT_EQ(heat_colour(2), heat_colour(1));
}

TEST(Canvas, TextStaysInsideItsBox) {
  const std::string text = "Cost 0123456789 {}|gjpqy\xff";
  Image image = blank_image(text_width(text) + 40, 60, {0, 0, 0});
  draw_text(image, 20, 20, text, {255, 255, 255});
  size_t drawn = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      if (pixel(image, x, y) == Colour{}) continue;
      ++drawn;
      EXPECT_TRUE(x >= 20 && x < 20 + text_width(text) && y >= 20 && y < 20 + kLineHeight) << x << ", " << y;
    }
  }
  EXPECT_GT(drawn, 500u);
}

TEST(Canvas, DrawingBeyondTheEdgesIsCut) {
  Image image = blank_image(10, 10, {1, 2, 3});
  fill_box(image, {8, 8, 100, 100}, {9, 9, 9});
  draw_image(image, blank_image(20, 20, {7, 7, 7}), 5, 5);
  draw_image(image, blank_image(20, 20, {7, 7, 7}), 50, 5);
  draw_text(image, 3, 3, "long text", {8, 8, 8});
  EXPECT_EQ(image.rgb.size(), 300u);
  EXPECT_EQ(pixel(image, 0, 0), (Colour{1, 2, 3}));
}

TEST(Canvas, ShortensLongText) {
  EXPECT_EQ(shortened_to("short", 1000), "short");
  const std::string cut = shortened_to(std::string(200, 'w'), 300);
  EXPECT_LE(text_width(cut), 300u);
  EXPECT_TRUE(cut.ends_with("w..."));
}

TEST(DepthCues, GrowWithDistanceAndMarkWhatLiesBehindEdges) {
  std::vector<float> distances;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) distances.push_back(x < 20 ? 1.0f : 3.0f);
  distances[5] = kInf;
  const DepthCues cues = depth_cues(distances, 40, 40);
  EXPECT_EQ(cues.far_share[20 * 40 + 2], 0);
  EXPECT_EQ(cues.far_share[20 * 40 + 38], 1);
  EXPECT_EQ(cues.far_share[5], 1);
  EXPECT_GT(cues.behind[20 * 40 + 20], 0.5f);
  EXPECT_EQ(cues.behind[20 * 40 + 38], 0);
  EXPECT_EQ(cues.behind[20 * 40 + 19], 0) << "the edge itself is in front";
}

TEST(DepthCues, StandWithoutAnyHit) {
  const std::vector<float> distances(16, kInf);
  for (const float behind : depth_cues(distances, 4, 4).behind) EXPECT_EQ(behind, 0);
}

TEST(PictureSize, FollowsTheWindow) {
  const PictureSize wide = picture_size(view_along_z(4, 2), 400);
  EXPECT_EQ(wide.width, 400u);
  EXPECT_EQ(wide.height, 200u);
  const PictureSize tall = picture_size(view_along_z(1, 1000), 400);
  EXPECT_EQ(tall.width, 16u);
  EXPECT_EQ(tall.height, 400u);
}

TEST(ShadedDepth, NearIsBrighterThanFarAndMissesAreDarkBlue) {
  const TriangleMesh mesh = two_steps();
  const Image image = shaded_depth(mesh, one_leaf(mesh), view_along_z(2, 2), 64, 64, 1);
  ASSERT_EQ(image.rgb.size(), 64u * 64 * 3);
  double brightest = 0, darkest = 100;
  size_t blue = 0;
  for (uint32_t i = 0; i < 64; ++i) {
    const Colour hit = pixel(image, i, 10), miss = pixel(image, i, 60);
    brightest = std::max(brightest, lightness(hit));
    darkest = std::min(darkest, lightness(hit));
    blue += miss.blue > miss.red && lightness(miss) < 25 ? 1 : 0;
  }
  EXPECT_GT(brightest - darkest, 15);
  EXPECT_EQ(blue, 64u);
}

TEST(ShadedDepth, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = two_steps();
  const Bvh bvh = one_leaf(mesh);
  EXPECT_EQ(shaded_depth(mesh, bvh, view_along_z(2, 2), 50, 40, 1).rgb,
            shaded_depth(mesh, bvh, view_along_z(2, 2), 50, 40, 4).rgb);
}

TEST(CostImage, CountsWhatRaysMeet) {
  const TriangleMesh mesh = two_steps();
  const Bvh bvh = one_leaf(mesh);
  const CostModel costs{2, 1.5f};
  const CostImage image = cost_image(bvh, mesh, view_along_z(2, 2), 32, 32, costs, 2);
  ASSERT_EQ(image.cost.size(), 32u * 32);
  EXPECT_EQ(image.cost[8 * 32 + 16], 4 * 1.5f) << "one leaf of four triangles";
  EXPECT_EQ(image.cost[30 * 32 + 16], 0) << "nothing there";
}

TEST(HeatMaps, ShareOneScaleWithItsColoursInTheBar) {
  CostImage low{220, 100, std::vector<float>(220 * 100, 10.0f)}, high = low;
  for (float& cost : high.cost) cost = 100;
  const std::pair<std::string, CostImage> maps[] = {{"low", low}, {"high", high}};
  const Image page = heat_maps(maps);
  EXPECT_GT(page.width, 440u);
  EXPECT_GT(page.height, 100u);
  std::set<int> colours;
  size_t low_pixels = 0, high_pixels = 0;
  for (uint32_t y = 0; y < page.height; ++y) {
    for (uint32_t x = 0; x < page.width; ++x) {
      const Colour c = pixel(page, x, y);
      colours.insert(c.red << 16 | c.green << 8 | c.blue);
      low_pixels += c == heat_colour(0.1) ? 1 : 0;
      high_pixels += c == heat_colour(1) ? 1 : 0;
    }
  }
  EXPECT_GE(low_pixels, 220u * 100);
  EXPECT_GE(high_pixels, 220u * 100);
  EXPECT_GT(colours.size(), 50u) << "the bar shows the whole scale";
}

TEST(HeatMaps, StandWithoutAnyCost) {
  const std::pair<std::string, CostImage> maps[] = {{"nothing", {16, 16, std::vector<float>(256, 0.0f)}}};
  EXPECT_GT(heat_maps(maps).width, 16u);
  EXPECT_GT(heat_maps({}).width, 0u);
}

TEST(Captioned, FramesThePicture) {
  const Image page = captioned(blank_image(300, 100, {200, 0, 0}), "title", "caption");
  EXPECT_GT(page.width, 300u);
  EXPECT_EQ(pixel(page, page.width / 2, page.height / 2), (Colour{200, 0, 0}));
}

}  // namespace
}  // namespace raygrain
