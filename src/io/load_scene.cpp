#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/scene_json.h"

namespace raygrain {
namespace {

std::string lower_case(std::string text) {
  for (char& symbol : text)
    if (symbol >= 'A' && symbol <= 'Z') symbol = static_cast<char>(symbol - 'A' + 'a');
  return text;
}

bool is_json(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string()) == ".json";
}

Scene load_mesh_alone(const std::string& path, const LoadOptions& options) {
  Scene scene;
  LoadReport report;
  scene.name = file_stem(path);
  scene.mesh = load_mesh(path, options, &report);
  scene.dropped_lines = report.dropped_lines;
  scene.dropped_points = report.dropped_points;
  return scene;
}

/// Can JSON say it? It knows neither NaN nor infinity; a missing tmax stands for one.
bool is_plain(const Ray& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && std::isfinite(ray.tmin) &&
         (std::isfinite(ray.tmax) || ray.tmax == kInf);
}

/// Lists of rays that JSON cannot hold go to CSV files beside the mesh; their names, by ray set.
std::vector<std::string> save_odd_rays(const Scene& scene, const std::filesystem::path& mesh_path) {
  std::vector<std::string> files(scene.ray_sets.size());
  for (size_t i = 0; i < files.size(); ++i) {
    const auto* rays = std::get_if<std::vector<Ray>>(&scene.ray_sets[i].source);
    if (rays == nullptr || std::ranges::all_of(*rays, is_plain)) continue;
    std::filesystem::path path = mesh_path;
    path.replace_filename(mesh_path.stem().string() + "-rays-" + std::to_string(i) + ".csv");
    save_rays(*rays, path.string());
    files[i] = path.filename().string();
  }
  return files;
}

}  // namespace

Scene load_scene(const std::string& scene, const LoadOptions& options) {
  if (scene.starts_with("procedural:")) return generate_scene(parse_procedural(scene));
  return is_json(scene) ? read_scene(scene, options) : load_mesh_alone(scene, options);
}

void save_scene(const Scene& scene, const std::string& path) {
  if (!is_json(path))
    throw Error(ErrorCode::kUsage, path, "a scene is saved as NAME.json and NAME.ply",
                "Give a name that ends in .json");
  const std::filesystem::path mesh_path = std::filesystem::path(path).replace_extension(".ply");
  save_mesh(scene.mesh, mesh_path.string());
  const std::string text = scene_json(scene, mesh_path.filename().string(), save_odd_rays(scene, mesh_path));
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

std::vector<Ray> make_rays(const RaySet& set, const TriangleMesh& mesh) {
  struct Maker {
    const RaySet& set;
    const TriangleMesh& mesh;

    std::vector<Ray> operator()(const AreaRays& rays) const { return cast_rays(rays, set.count, set.seed); }
    std::vector<Ray> operator()(const SurfaceRays& rays) const { return cast_rays(rays, mesh, set.count, set.seed); }
    std::vector<Ray> operator()(const CameraRays& rays) const { return cast_rays(rays); }
    std::vector<Ray> operator()(const std::vector<Ray>& rays) const { return rays; }
  };
  return std::visit(Maker{set, mesh}, set.source);
}

size_t ray_count(const RaySet& set) {
  if (const auto* camera = std::get_if<CameraRays>(&set.source)) return size_t{camera->width} * camera->height;
  if (const auto* rays = std::get_if<std::vector<Ray>>(&set.source)) return rays->size();
  return set.count;
}

}  // namespace raygrain
