// JSON files: scenes, areas, studies.
#include <algorithm>

#include "raygrain/io.h"
#include "raygrain/study.h"

#include "files.h"
#include "io/scene_json.h"

namespace raygrain::fuzz {

namespace {

constexpr size_t kMostRays = 256;
constexpr uint32_t kMostPixels = 8;

/// A folder with what the documents of the corpus name.
const PrivateFolder& folder() {
  static const PrivateFolder folder;
  static const bool filled = [] {
    folder.put("mesh.obj", kQuadObj);
    folder.put("cube.obj", kCubeObj);
    folder.put("rays.csv", kThreeRays);
    return true;
  }();
  static_cast<void>(filled);
  return folder;
}

/// Many rays are no defect.
void cast_a_few(RaySet set, const TriangleMesh& mesh) {
  set.count = std::min(set.count, kMostRays);
  if (auto* camera = std::get_if<CameraRays>(&set.source)) {
    camera->width = std::min(camera->width, kMostPixels);
    camera->height = std::min(camera->height, kMostPixels);
  }
  const std::vector<Ray> rays = make_rays(set, mesh);
  require(rays.size() <= std::max(ray_count(set), kMostRays), "more rays than announced");
}

/// What is written is read back.
void check_written(const Scene& scene) {
  const std::vector<std::string> no_ray_files(scene.ray_sets.size());
  const std::string path = folder().put("written.json", scene_json(scene, "mesh.obj", no_ray_files));
  if (scene.areas.empty()) return;
  const std::vector<InfluenceArea> areas = load_areas(path, mesh_bounds(scene.mesh));
  require(areas.size() == scene.areas.size(), "a written scene has other areas");
  for (size_t i = 0; i < areas.size(); ++i)
    require(areas[i].name == scene.areas[i].name, "a written area has another name");
}

}  // namespace

void scene(Bytes bytes) {
  if (names_a_large_scene(text_of(bytes))) return;
  const std::string path = folder().put("fuzzed.json", bytes);
  Scene scene;
  if (!accepts([&] { scene = load_scene(path); })) return;
  require(!scene.mesh.triangles.empty(), "a scene without triangles");
  validate(scene.mesh, "fuzzed");
  for (const RaySet& set : scene.ray_sets) accepts([&] { cast_a_few(set, scene.mesh); });
  for (const InfluenceArea& area : scene.areas) {
    validate(area, "fuzzed");
    AreaGeometry{area};
  }
  check_written(scene);
}

void areas(Bytes bytes) {
  const std::string text = text_of(bytes);
  if (names_a_large_scene(text)) return;
  const std::string path = folder().put("fuzzed.json", bytes);
  std::vector<InfluenceArea> areas;
  if (!accepts([&] { areas = load_areas(path, {{-1, -1, -1}, {1, 2, 3}}); })) return;
  for (const InfluenceArea& area : areas) {
    validate(area, "fuzzed");
    const AreaGeometry geometry(area);
    accepts([&] { cast_rays(AreaRays{area}, 16, 1); });
  }
}

void study(Bytes bytes) {
  if (names_a_large_scene(text_of(bytes))) return;
  const std::string path = folder().put("fuzzed.json", bytes);
  accepts([&] {
    const Study study = make_study(load_study_grid(path, {}));
    require(!study.name.empty(), "a study without a name");
  });
}

}  // namespace raygrain::fuzz
