// What scene.json refuses, and how it says so.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "support/shared.h"

namespace raygrain {
namespace {

const char* const kHead = R"({"format": "raygrain-scene", "version": 1, "meshes": [{"file": "one.ply"}])";

struct BadScene {
  const char* what;
  std::string text;
  ErrorCode code;
  const char* where;     // the end of Error::where
  const char* fragment;  // of the whole message
};

// Into a fresh file: overwriting one makes some file systems wait for the disk.
void write_fresh(const std::string& path, const std::string& text) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << text;
}

// A scene of one triangle with this member more.
std::string with(const std::string& member) {
  return std::string(kHead) + ", " + member + "}";
}
std::string with_area(const std::string& area) {
  return with("\"areas\": [" + area + "]");
}
std::string with_plane(const std::string& plane) {
  return with_area(R"({"name": "a", "plane": {)" + plane + "}}");
}
std::string with_point(const std::string& point) {
  return with_area(R"({"name": "a", "point": {"eye": [0, 0, 0], "forward": [0, 0, 1], )" + point + "}}");
}
std::string with_rays(const std::string& set) {
  return with(R"("areas": [{"name": "sunny", "sun": {"direction": [0, -1, 0]}}], "rays": [)" + set + "]");
}
std::string with_mesh(const std::string& placement) {
  return R"({"format": "raygrain-scene", "version": 1, "meshes": [{"file": "one.ply", )" + placement + "}]}";
}

std::vector<BadScene> syntax_rows() {
  const ErrorCode malformed = ErrorCode::kMalformed;
  return {
      {"empty file", "", malformed, "scene.json:1:1", "ends too early"},
      {"text garbage", "hello", malformed, "scene.json:1:1", "not JSON"},
      {"missing comma", "{\"format\": 1\n  \"version\": 1}", malformed, "scene.json:2:11", "not JSON"},
      {"cut off", "{\"format\": \"raygrain-scene\",\n\"vers", malformed, "scene.json:2:6", "ends too early"},
      {"comment", "{} // mine", malformed, "scene.json:1:4", "no comments"},
      {"NaN", with_plane(R"("depth": NaN)"), malformed, "", "NaN"},
      {"number beyond double", with_plane(R"("depth": 1e999)"), malformed, "", "too large"},
      {"key twice", R"({"format": "raygrain-scene", "format": "x"})", malformed, "scene.json",
       "\"format\" is there twice"},
      {"nesting", std::string(100000, '['), ErrorCode::kLimit, "scene.json", "levels"},
      {"broken UTF-8", "{\"name\": \"\xff\"}", malformed, "scene.json:1:11", "not JSON"},
      {"array at the top", "[]", malformed, "scene.json", "an array, not an object"},
  };
}

std::vector<BadScene> document_rows() {
  const ErrorCode malformed = ErrorCode::kMalformed, unsupported = ErrorCode::kUnsupported;
  return {
      {"no format", "{}", malformed, "scene.json", "Start with \"format\": \"raygrain-scene\""},
      {"other format", R"({"format": "gltf", "version": 1})", unsupported, "#/format", "\"gltf\""},
      {"newer version", R"({"format": "raygrain-scene", "version": 2})", unsupported, "#/version", "newer"},
      {"version as text", R"({"format": "raygrain-scene", "version": "1"})", malformed, "#/version",
       "a text, not a number"},
      {"no mesh", R"({"format": "raygrain-scene", "version": 1})", malformed, "scene.json",
       "one of \"meshes\" or \"procedural\" is missing"},
      {"mesh and procedural", with(R"("procedural": "procedural:city")"), malformed, "scene.json",
       "both \"meshes\" and \"procedural\""},
      {"no meshes at all", R"({"format": "raygrain-scene", "version": 1, "meshes": []})", malformed, "#/meshes",
       "no mesh"},
      {"unknown procedural", R"({"format": "raygrain-scene", "version": 1, "procedural": "procedural:cty"})",
       ErrorCode::kUsage, "#/procedural", "\"city\""},
      {"unknown key", with(R"("area": [])"), malformed, "scene.json", "Did you mean \"areas\"?"},
      {"far-off key", with(R"("something": 1)"), malformed, "scene.json", "Known: format, version"},
      {"empty name", with(R"("name": "")"), malformed, "#/name", "empty"},
      {"missing mesh file", R"({"format": "raygrain-scene", "version": 1, "meshes": [{"file": "two.ply"}]})",
       ErrorCode::kNotFound, "two.ply", ""},
      {"mesh without file", R"({"format": "raygrain-scene", "version": 1, "meshes": [{}]})", malformed, "#/meshes/0",
       "\"file\" is missing"},
  };
}

std::vector<BadScene> mesh_rows() {
  const ErrorCode malformed = ErrorCode::kMalformed;
  return {
      {"unknown mesh key", with_mesh(R"("scal": 2)"), malformed, "#/meshes/0", "Did you mean \"scale\"?"},
      {"scale 0", with_mesh(R"("scale": 0)"), malformed, "#/meshes/0/scale", "leaves nothing"},
      {"scale of two", with_mesh(R"("scale": [1, 2])"), malformed, "#/meshes/0/scale", "2 items, not 3"},
      {"matrix of nine", with_mesh(R"("matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1])"), malformed, "#/meshes/0/matrix",
       "not 12 or 16"},
      {"perspective", with_mesh(R"("matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,0])"), malformed, "#/meshes/0/matrix",
       "last row"},
      {"matrix and scale", with_mesh(R"("matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0], "scale": 2)"), malformed, "#/meshes/0",
       "both"},
      {"zero axis", with_mesh(R"("rotate": {"axis": [0, 0, 0], "degrees": 4})"), malformed, "#/meshes/0/rotate",
       "axis is zero"},
      {"wild angle", with_mesh(R"("rotate": {"axis": [0, 1, 0], "degrees": 1e9})"), malformed, "#/meshes/0/rotate",
       "-360 to 360"},
      {"beyond float", with_mesh(R"("translate": [1e39, 0, 0])"), malformed, "#/meshes/0/translate/0",
       "too large for a float"},
      {"scaled to infinity", with_mesh(R"("scale": 3e38)"), ErrorCode::kBadMesh, "#/meshes/0", "vertex"},
  };
}

std::vector<BadScene> area_rows() {
  const ErrorCode malformed = ErrorCode::kMalformed, bad = ErrorCode::kBadArea;
  const std::string plane = R"("center": [0, 0, 0], "direction": [0, 0, 1], "half_width": 1, "half_height": 1, )";
  const std::string point = R"("fov_x": 90, "fov_y": 90, )";
  return {
      {"area without name", with_area(R"({"sun": {"direction": [0, -1, 0]}})"), malformed, "#/areas/0",
       "\"name\" is missing"},
      {"area without shape", with_area(R"({"name": "a"})"), malformed, "#/areas/0", "\"camera\" is missing"},
      {"two shapes", with_area(R"({"name": "a", "sun": {"direction": [0,-1,0]}, "light": {"position": [0,1,0]}})"),
       malformed, "#/areas/0", "both"},
      {"unknown field", with_plane(plane + R"("dept": 3)"), malformed, "#/areas/0/plane", "Did you mean \"depth\"?"},
      {"missing field", with_plane(plane.substr(0, plane.size() - 2)), malformed, "#/areas/0/plane",
       "\"depth\" is missing"},
      {"text for number", with_plane(plane + R"("depth": "3")"), malformed, "#/areas/0/plane/depth",
       "a text, not a number"},
      {"number for vector", with_plane(R"("center": 3)"), malformed, "#/areas/0/plane/center",
       "a number, not an array"},
      {"null in vector", with_plane(R"("center": [0, null, 0])"), malformed, "#/areas/0/plane/center/1",
       "null, not a number"},
      {"zero size", with_plane(plane + R"("depth": 0)"), bad, "#/areas/0", "depth"},
      {"negative size", with_plane(plane + R"("depth": -1)"), bad, "#/areas/0", "depth"},
      {"zero direction", with_area(R"({"name": "a", "sun": {"direction": [0, 0, 0]}})"), bad, "#/areas/0/sun",
       "direction"},
      {"near beyond far", with_point(point + R"("near_z": 2, "far_z": 1)"), bad, "#/areas/0", "near_z"},
      {"near 0", with_point(point + R"("near_z": 0, "far_z": 1)"), bad, "#/areas/0", "near_z"},
      {"field of view 180", with_point(R"("fov_x": 180, "fov_y": 90, "near_z": 1, "far_z": 2)"), bad, "#/areas/0",
       "fov_x"},
      {"camera's view 180", with_area(R"({"name": "a", "camera": {"eye": [0,0,9], "target": [0,0,0], "fov_y": 180}})"),
       bad, "#/areas/0/camera", "fov"},
      {"camera at its target",
       with_area(R"({"name": "a", "camera": {"eye": [0,0,9], "target": [0,0,9], "fov_y": 60}})"), bad,
       "#/areas/0/camera", ""},
      {"tolerance 1", with_area(R"({"name": "a", "sun": {"direction": [0, -1, 0]}, "tolerance": 1})"), bad, "#/areas/0",
       "tolerance"},
      {"name twice",
       with_area(R"({"name": "a", "sun": {"direction": [0,-1,0]}}, {"name": "a", "sun": {"direction": [0,-1,1]}})"),
       malformed, "#/areas/1", "another area has the name \"a\""},
      {"name of a light's part",
       with_area(R"({"name": "a", "light": {"position": [0,9,0]}}, {"name": "a-z", "sun": {"direction": [0,-1,1]}})"),
       malformed, "#/areas/1", "\"a-z\""},
  };
}

std::vector<BadScene> ray_rows() {
  const ErrorCode malformed = ErrorCode::kMalformed, usage = ErrorCode::kUsage;
  return {
      {"unknown area", with_rays(R"({"name": "r", "area": "suny"})"), malformed, "#/rays/0/area",
       "Did you mean \"sunny\"?"},
      {"unknown start", with_rays(R"({"name": "r", "area": "sunny", "start": "nea"})"), malformed, "#/rays/0/start",
       "\"near\""},
      {"wide cone", with_rays(R"({"name": "r", "area": "sunny", "cone_degrees": 91})"), usage, "#/rays/0",
       "cone_degrees"},
      {"negative jitter", with_rays(R"({"name": "r", "area": "sunny", "jitter_radius": -1})"), usage, "#/rays/0",
       "jitter_radius"},
      {"negative count", with_rays(R"({"name": "r", "area": "sunny", "count": -1})"), malformed, "#/rays/0/count",
       "-1 is no whole number"},
      {"broken count", with_rays(R"({"name": "r", "area": "sunny", "count": 1.5})"), malformed, "#/rays/0/count",
       "1.5"},
      {"great count", with_rays(R"({"name": "r", "area": "sunny", "count": 2000000000})"), malformed, "#/rays/0/count",
       "1000000000"},
      {"great seed", with_rays(R"({"name": "r", "area": "sunny", "seed": 18446744073709551616})"), malformed,
       "#/rays/0/seed", "no whole number"},
      {"a light's rays", with_rays(R"({"name": "r", "area": {"name": "l", "light": {"position": [0, 9, 0]}}})"),
       malformed, "#/rays/0/area", "six"},
      {"no target", with_rays(R"({"name": "r", "surface": {}})"), malformed, "#/rays/0/surface", "is missing"},
      {"zero target", with_rays(R"({"name": "r", "surface": {"direction": [0, 0, 0]}})"), usage, "#/rays/0/surface",
       "zero"},
      {"camera without pixels",
       with_rays(R"({"name": "r", "camera": {"eye": [0,0,9], "target": [0,0,0], "width": 0, "height": 4}})"), malformed,
       "#/rays/0/camera/width", "1 to 32768"},
      {"count of a camera", with_rays(R"({"name": "r", "camera": {}, "count": 4})"), malformed, "#/rays/0",
       "unknown key \"count\""},
      {"ray of seven", with_rays(R"({"name": "r", "rays": [[0, 0, 0, 0, 0, 1, 0]]})"), malformed, "#/rays/0/rays/0",
       "7 numbers"},
      {"missing ray file", with_rays(R"({"name": "r", "file": "no.csv"})"), ErrorCode::kNotFound, "no.csv", ""},
      {"endless ray file", with_rays(R"({"name": "r", "file": "/dev/zero"})"), ErrorCode::kUnreadable, "#/rays/0/file",
       "no regular file"},
      {"set twice", with_rays(R"({"name": "r", "rays": []}, {"name": "r", "rays": []})"), malformed, "#/rays/1",
       "another ray set"},
  };
}

class SceneErrors : public testing::Test {
 protected:
  SceneErrors() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 20, 40}};
    mesh.triangles = {{0, 1, 2}};
    save_mesh(mesh, folder_.file("one.ply"));
  }
  void expect_refused(const BadScene& row) {
    SCOPED_TRACE(row.what);
    try {
      load_text(row.text);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, row.code) << error.what();
      EXPECT_NE(std::string(error.what()).find(row.fragment), std::string::npos) << error.what();
      EXPECT_TRUE(error.where.ends_with(row.where)) << error.what();
      EXPECT_TRUE(error.where.starts_with(folder_.path())) << error.what();
    }
  }
  Scene load_text(const std::string& text) {
    write_fresh(folder_.file("scene.json"), text);
    return load_scene(folder_.file("scene.json"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(SceneErrors, Syntax) {
  for (const BadScene& row : syntax_rows()) expect_refused(row);
}
TEST_F(SceneErrors, Document) {
  for (const BadScene& row : document_rows()) expect_refused(row);
}
TEST_F(SceneErrors, Meshes) {
  for (const BadScene& row : mesh_rows()) expect_refused(row);
}
TEST_F(SceneErrors, Areas) {
  for (const BadScene& row : area_rows()) expect_refused(row);
}
TEST_F(SceneErrors, Rays) {
  for (const BadScene& row : ray_rows()) expect_refused(row);
}

TEST_F(SceneErrors, MissingFile) {
  try {
    load_scene(folder_.file("none.json"));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kNotFound);
  }
}

// What every row above varies is good as it stands.
TEST_F(SceneErrors, NotForTheUnspoiledScene) {
  EXPECT_EQ(load_text(with_rays(R"({"name": "r", "area": "sunny"})")).ray_sets.size(), 1u);
  EXPECT_EQ(load_text(with_mesh(R"("scale": 2)")).mesh.triangle_count(), 1u);
}

}  // namespace
}  // namespace raygrain
