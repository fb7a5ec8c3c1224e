// The examples of docs/formats.md are what they say they are.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "support/shared.h"

namespace raygrain {
namespace {

std::string formats_document() {
  std::ifstream file(test::source_folder() / "docs" / "formats.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

// The first example after a heading, between its fences.
std::string example_after(const std::string& heading) {
  const std::string document = formats_document();
  const size_t fence = document.find("```", document.find("\n" + heading + "\n"));
  const size_t begin = document.find('\n', fence), end = document.find("\n```", begin);
  return end == std::string::npos ? "" : document.substr(begin + 1, end - begin);
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

TEST(FormatsDocument, SceneLoads) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{-3, 0, -3}, {3, 0, -3}, {0, 1, 3}};
  mesh.triangles = {{0, 1, 2}};
  std::filesystem::create_directory(folder.file("models"));
  save_mesh(mesh, folder.file("house.ply"));
  save_mesh(mesh, folder.file("models/tree.obj"));
  write_text(folder.file("scene.json"), example_after("## scene.json"));
  const Scene scene = load_scene(folder.file("scene.json"));
  EXPECT_EQ(scene.name, "courtyard");
  EXPECT_EQ(scene.mesh.triangle_count(), 2u);
  EXPECT_EQ(scene.areas.size(), 9u);
  ASSERT_EQ(scene.ray_sets.size(), 3u);
  EXPECT_EQ(make_rays(scene.ray_sets[0], scene.mesh).size(), 10000u);
  EXPECT_EQ(make_rays(scene.ray_sets[1], scene.mesh).size(), 5000u);
  EXPECT_EQ(make_rays(scene.ray_sets[2], scene.mesh).size(), 320u * 200u);
}

TEST(FormatsDocument, AreasLoad) {
  const test::TemporaryFolder folder;
  write_text(folder.file("areas.json"), example_after("### Areas alone"));
  EXPECT_EQ(load_areas(folder.file("areas.json")).size(), 1u);
}

TEST(FormatsDocument, RaysLoad) {
  const test::TemporaryFolder folder;
  write_text(folder.file("rays.csv"), example_after("## Rays (CSV)"));
  EXPECT_EQ(load_rays(folder.file("rays.csv")).size(), 2u);
}

TEST(FormatsDocument, HitsAreWrittenSo) {
  const test::TemporaryFolder folder;
  const Hit hits[] = {{9.25f, 0.125f, 0.5f, 4711}, {}};
  save_hits(hits, folder.file("hits.csv"));
  std::ifstream file(folder.file("hits.csv"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), example_after("## Hits (CSV)"));
}

}  // namespace
}  // namespace raygrain
