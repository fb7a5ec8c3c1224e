#include "raygrain/scene.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "support/shared.h"

namespace raygrain {
namespace {

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

bool same_bits(Vec3 a, Vec3 b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_same(const InfluenceArea& a, const InfluenceArea& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.tolerance, b.tolerance);
  ASSERT_EQ(a.shape.index(), b.shape.index());
  if (const auto* plane = std::get_if<PlaneArea>(&a.shape)) {
    EXPECT_EQ(std::memcmp(plane, &std::get<PlaneArea>(b.shape), sizeof *plane), 0);
  } else {
    EXPECT_EQ(std::memcmp(&std::get<PointArea>(a.shape), &std::get<PointArea>(b.shape), sizeof(PointArea)), 0);
  }
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (size_t i = 0; i < a.vertices.size(); ++i) ASSERT_TRUE(same_bits(a.vertices[i], b.vertices[i])) << i;
}

void expect_same(const RaySet& a, const RaySet& b, const TriangleMesh& mesh) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.seed, b.seed);
  ASSERT_EQ(a.source.index(), b.source.index());
  const std::vector<Ray> x = make_rays(a, mesh), y = make_rays(b, mesh);
  ASSERT_EQ(x.size(), y.size());
  for (size_t i = 0; i < x.size(); ++i) ASSERT_EQ(std::memcmp(&x[i], &y[i], sizeof(Ray)), 0) << a.name << " " << i;
}

// Every kind of area and ray set, with floats that have no short decimals.
Scene rich_scene() {
  Scene scene = generate_scene({"random100", 0, 1});
  scene.name = "a \"quoted\" name, \xc3\xa9 and a \\ and a \n";
  scene.mesh.vertices[0].x = -0.0f;
  scene.mesh.vertices[1].y = 1e-40f;
  scene.areas.push_back(
      {"lamp/~1", PointArea{{0.1f, 1 / 3.0f, -0.0f}, {1e-30f, -1, 7e20f}, {0, 0, 1}, 33.3f, 179, 1e-6f, 3e5f}, 0.3f});
  const InfluenceArea stranger{"sun", PlaneArea{{1, 2, 3}, {0, 0.7f, 0.1f}, {1, 0, 0}, 16777218, 0.1f, 1e20f}, 0};
  scene.ray_sets.push_back(
      {"lamp", AreaRays{scene.areas[1], RayStart::kRandomDepth, PointSpread::kAngle, 0.7f, 0.3f}, 50, ~uint64_t{0}});
  scene.ray_sets.push_back({"stranger", AreaRays{stranger}, 0, 0});
  scene.ray_sets.push_back({"to the sun", SurfaceRays{TowardsDirection{{0.35f, -0.8f, 0.48f}}}, 20, 3});
  scene.ray_sets.push_back({"to a point", SurfaceRays{TowardsPoint{{0.1f, 20, 0.3f}}}, 20, 4});
  scene.ray_sets.push_back(
      {"to a window", SurfaceRays{TowardsRectangle{{0.1f, 20, 0.3f}, {1, 0, 0}, {0, 0, 0.7f}}}, 20, 5});
  scene.ray_sets.push_back({"camera", CameraRays{{1, 2, 30}, {0.1f, 0.2f, 0.3f}, {0, 1, 0.1f}, 33.3f, 7, 5}});
  scene.ray_sets.push_back({"as they are", std::vector<Ray>{{{0.1f, -0.0f, 1e-42f}, {1 / 3.0f, 0, 3e38f}},
                                                            {{1, 2, 3}, {0, 1, 0}, 0.25f, 1e9f}}});
  scene.ray_sets.push_back({"none", std::vector<Ray>{}});
  return scene;
}

TEST(Scene, SavedAndLoadedIsTheSameBitForBit) {
  const test::TemporaryFolder folder;
  const Scene before = rich_scene();
  save_scene(before, folder.file("rich.json"));
  const Scene after = load_scene(folder.file("rich.json"));
  EXPECT_EQ(before.name, after.name);
  expect_same(before.mesh, after.mesh);
  ASSERT_EQ(before.areas.size(), after.areas.size());
  for (size_t i = 0; i < before.areas.size(); ++i) expect_same(before.areas[i], after.areas[i]);
  ASSERT_EQ(before.ray_sets.size(), after.ray_sets.size());
  for (size_t i = 0; i < before.ray_sets.size(); ++i) {
    expect_same(before.ray_sets[i], after.ray_sets[i], before.mesh);
    if (const auto* rays = std::get_if<AreaRays>(&before.ray_sets[i].source))
      expect_same(rays->area, std::get<AreaRays>(after.ray_sets[i].source).area);
  }
}

// JSON knows neither NaN nor infinity.
TEST(Scene, RaysThatJsonCannotHoldSurviveToo) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const test::TemporaryFolder folder;
  Scene before = generate_scene({"random100", 0, 1});
  before.ray_sets = {{"plain", std::vector<Ray>{{{1, 2, 3}, {0, 1, 0}}}},
                     {"odd", std::vector<Ray>{{{1, 2, 3}, {0, 1, 0}, -kInf, 1},
                                              {{kInf, 2, 3}, {0, -kInf, 0}},
                                              {{1, 2, 3}, {0, 1, 0}, 0, -kInf},
                                              {{nan, 2, 3}, {0, 1, nan}, nan, nan}}}};
  save_scene(before, folder.file("odd.json"));
  const Scene after = load_scene(folder.file("odd.json"));
  ASSERT_EQ(after.ray_sets.size(), 2u);
  for (size_t i = 0; i < 2; ++i) expect_same(before.ray_sets[i], after.ray_sets[i], before.mesh);
  EXPECT_TRUE(std::filesystem::exists(folder.file("odd-rays-1.csv")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("odd-rays-0.csv")));
}

TEST(Scene, ProceduralScenesSurviveTheirFiles) {
  for (const char* kind : {"city", "forest", "terrain", "random1000"}) {
    SCOPED_TRACE(kind);
    const test::TemporaryFolder folder;
    const Scene before = generate_scene({kind, 3, 5});
    save_scene(before, folder.file("scene.json"));
    const Scene after = load_scene(folder.file("scene.json"));
    EXPECT_EQ(before.name, after.name);
    expect_same(before.mesh, after.mesh);
    expect_same(before.areas.at(0), after.areas.at(0));
    expect_same(before.ray_sets.at(0), after.ray_sets.at(0), before.mesh);
  }
}

TEST(Scene, NamesThatAreNoUtf8AreStillReadable) {
  const test::TemporaryFolder folder;
  Scene scene = generate_scene({"random100", 0, 1});
  scene.name = "caf\xe9";
  save_scene(scene, folder.file("latin.json"));
  EXPECT_EQ(load_scene(folder.file("latin.json")).name, "caf\xef\xbf\xbd");
}

TEST(Scene, IsSavedAsJsonOnly) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(save_scene(rich_scene(), folder.file("scene.ply")), Error);
}

TEST(Scene, FromAMeshAloneHasNoAreas) {
  const test::TemporaryFolder folder;
  const TriangleMesh mesh = generate_scene({"random100", 0, 1}).mesh;
  save_mesh(mesh, folder.file("some.mesh.ply"));
  const Scene scene = load_scene(folder.file("some.mesh.ply"));
  EXPECT_EQ(scene.name, "some.mesh");
  expect_same(scene.mesh, mesh);
  EXPECT_TRUE(scene.areas.empty());
  EXPECT_TRUE(scene.ray_sets.empty());
}

TEST(Scene, FromAProceduralName) {
  const Scene scene = load_scene("procedural:terrain?size=10&seed=4");
  expect_same(scene.mesh, generate_scene({"terrain", 10, 4}).mesh);
  EXPECT_EQ(scene.name, "procedural:terrain?size=10&seed=4");
}

// A folder with one triangle and a scene.json around it.
class SceneFile {
 public:
  SceneFile() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 4}};
    mesh.triangles = {{0, 1, 2}};
    save_mesh(mesh, folder_.file("one.ply"));
  }
  std::string write(const std::string& text) const {
    write_text(folder_.file("scene.json"), text);
    return folder_.file("scene.json");
  }
  Scene load(const std::string& members) const {
    return load_scene(write(R"({"format": "raygrain-scene", "version": 1, )" + members + "}"));
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

 private:
  test::TemporaryFolder folder_;
};

std::vector<Vec3> placed_vertices(const std::string& placement) {
  return SceneFile().load(R"("meshes": [{"file": "one.ply")" + placement + "}]").mesh.vertices;
}

TEST(SceneJson, PlacesMeshes) {
  EXPECT_EQ(placed_vertices(""), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 4}}));
  EXPECT_EQ(placed_vertices(R"(, "scale": 1.5)"), (std::vector<Vec3>{{0, 0, 0}, {1.5, 0, 0}, {0, 3, 6}}));
  EXPECT_EQ(placed_vertices(R"(, "scale": [2, 3, 0.5])"), (std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 6, 2}}));
  EXPECT_EQ(placed_vertices(R"(, "translate": [1, 2, 3], "scale": 2)"),
            (std::vector<Vec3>{{1, 2, 3}, {3, 2, 3}, {1, 6, 11}}));
  const std::vector<Vec3> by_rows{{10, 20, 30}, {10, 21, 30}, {12, 20, 34}};
  EXPECT_EQ(placed_vertices(R"(, "matrix": [0, 1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30])"), by_rows);
  EXPECT_EQ(placed_vertices(R"(, "matrix": [0, 1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1])"), by_rows);
}

// Scaled first, then turned (counterclockwise around the axis that points at the viewer), then moved.
TEST(SceneJson, TurnsMeshes) {
  const std::vector<Vec3> found =
      placed_vertices(R"(, "scale": [1, 1, 2], "rotate": {"axis": [0, 3, 0], "degrees": 90}, "translate": [0, 5, 0])");
  const Vec3d expected[] = {{0, 5, 0}, {0, 5, -1}, {8, 7, 0}};
  for (size_t i = 0; i < 3; ++i) EXPECT_LT(length(to_double(found[i]) - expected[i]), 1e-6) << i;
}

TEST(SceneJson, JoinsMeshesInOrder) {
  const Scene scene = SceneFile().load(
      R"("name": "two", "meshes": [{"file": "one.ply"}, {"file": "one.ply", "translate": [0, 0, 9]}])");
  EXPECT_EQ(scene.name, "two");
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(scene.mesh.triangles[1], (std::array<uint32_t, 3>{3, 4, 5}));
  EXPECT_EQ(scene.mesh.vertices[5], (Vec3{0, 2, 13}));
}

TEST(SceneJson, ShorthandsCoverTheScene) {
  const Scene scene = SceneFile().load(R"("meshes": [{"file": "one.ply"}], "areas": [
    {"name": "noon", "sun": {"direction": [0, -1, 0.1]}, "tolerance": 0.02},
    {"name": "lamp", "light": {"position": [0.5, 9, 1]}},
    {"name": "eye", "camera": {"eye": [0, 1, 20], "target": [0, 1, 0], "fov_y": 40, "aspect": 1.5}}])");
  const Bounds box = mesh_bounds(scene.mesh);
  ASSERT_EQ(scene.areas.size(), 8u);
  expect_same(scene.areas[0], [&] {
    InfluenceArea sun = directional_light_area("noon", {0, -1, 0.1f}, box);
    sun.tolerance = 0.02f;
    return sun;
  }());
  const std::vector<InfluenceArea> lamp = point_light_areas("lamp", {0.5f, 9, 1}, box);
  for (size_t i = 0; i < 6; ++i) expect_same(scene.areas[1 + i], lamp[i]);
  expect_same(scene.areas[7], camera_area("eye", {0, 1, 20}, {0, 1, 0}, 40, 1.5f, box));
}

TEST(SceneJson, ProceduralBringsItsOwnAreasUnlessOthersAreGiven) {
  const SceneFile file;
  const Scene own = file.load(R"("procedural": "procedural:random100")");
  EXPECT_EQ(own.areas.at(0).name, "sun");
  EXPECT_EQ(own.ray_sets.at(0).name, "sun");
  EXPECT_EQ(own.name, "scene");
  const Scene other = file.load(
      R"("procedural": "procedural:random100", "areas": [{"name": "noon", "sun": {"direction": [0, -1, 0]}}])");
  ASSERT_EQ(other.areas.size(), 1u);
  EXPECT_EQ(other.areas[0].name, "noon");
  EXPECT_TRUE(other.ray_sets.empty());
}

TEST(RayCount, IsWhatMakeRaysGives) {
  Scene scene = rich_scene();
  scene.ray_sets.push_back({"view", CameraRays{{0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 60, 32, 20}});
  scene.ray_sets.push_back({"list", std::vector<Ray>(7)});
  for (const RaySet& set : scene.ray_sets) EXPECT_EQ(ray_count(set), make_rays(set, scene.mesh).size()) << set.name;
}

TEST(SceneJson, RaysOfAFile) {
  const SceneFile file;
  const std::vector<Ray> rays{{{0.1f, 2, 3}, {0, 0, -1}}, {{1, 1, 1}, {0, 1, 0}, 0.5f, 2}};
  save_rays(rays, file.file("rays.csv"));
  const Scene scene = file.load(R"("meshes": [{"file": "one.ply"}], "rays": [{"name": "mine", "file": "rays.csv"}])");
  const std::vector<Ray> found = make_rays(scene.ray_sets.at(0), scene.mesh);
  ASSERT_EQ(found.size(), 2u);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(std::memcmp(&found[i], &rays[i], sizeof(Ray)), 0);
}

TEST(LoadAreas, FromAFileOfAreasAlone) {
  const SceneFile file;
  const std::string path = file.write(R"({"format": "raygrain-areas", "version": 1, "areas": [
    {"name": "a", "plane": {"center": [0, 9, 0], "direction": [0, -1, 0], "half_width": 2, "half_height": 3, "depth": 20}}]})");
  const std::vector<InfluenceArea> areas = load_areas(path);
  ASSERT_EQ(areas.size(), 1u);
  expect_same(areas[0], {"a", PlaneArea{{0, 9, 0}, {0, -1, 0}, {0, 1, 0}, 2, 3, 20}});
}

TEST(LoadAreas, NeedsNoFormatButNoWrongOne) {
  const SceneFile file;
  const std::string areas = R"("areas": [{"name": "s", "sun": {"direction": [0, -1, 0]}}]})";
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(load_areas(file.write("{" + areas), box).size(), 1u);
  EXPECT_EQ(load_areas(file.write(R"({"format": "raygrain-areas", "version": 1, )" + areas), box).size(), 1u);
  for (const char* head : {R"({"format": "raygrain-areas", "version": 2, )", R"({"format": "gltf", "version": 1, )",
                           R"({"version": 1, )", R"({"name": "x", )"})
    EXPECT_THROW(load_areas(file.write(head + areas), box), Error) << head;
  EXPECT_THROW(load_areas(file.write("{}"), box), Error);
  EXPECT_THROW(load_areas(file.write(R"({"areas": []})"), box), Error);
}

TEST(LoadAreas, ShorthandsNeedAScene) {
  const SceneFile file;
  const std::string path = file.write(
      R"({"format": "raygrain-areas", "version": 1, "areas": [{"name": "s", "sun": {"direction": [0, -1, 0]}}]})");
  EXPECT_THROW(load_areas(path), Error);
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  expect_same(load_areas(path, box).at(0), directional_light_area("s", {0, -1, 0}, box));
}

TEST(LoadAreas, FromAWholeScene) {
  const SceneFile file;
  const std::string path = file.write(R"({"format": "raygrain-scene", "version": 1, "meshes": [{"file": "one.ply"}],
    "areas": [{"name": "s", "sun": {"direction": [0, -1, 0]}}]})");
  const Bounds box{{0, 0, 0}, {1, 2, 4}}, other{{0, 0, 0}, {7, 7, 7}};
  expect_same(load_areas(path).at(0), directional_light_area("s", {0, -1, 0}, box));
  expect_same(load_areas(path, other).at(0), directional_light_area("s", {0, -1, 0}, other));
  const std::string procedural =
      file.write(R"({"format": "raygrain-scene", "version": 1, "procedural": "procedural:random100"})");
  EXPECT_EQ(load_areas(procedural).at(0).name, "sun");
  EXPECT_EQ(load_areas(procedural, box).at(0).name, "sun");
}

}  // namespace
}  // namespace raygrain
