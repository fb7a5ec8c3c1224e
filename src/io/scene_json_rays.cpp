#include <array>
#include <filesystem>
#include <set>

#include "base/nearest_name.h"
#include "io/scene_json.h"

namespace raygrain {
namespace {

constexpr uint64_t kMostRays = 1'000'000'000, kMostSeed = ~uint64_t{0};
constexpr uint32_t kMostPixels = 32768;  // per side
constexpr std::array<std::string_view, 5> kSources{"area", "surface", "camera", "rays", "file"};

// An area by its name, or described in place.
InfluenceArea read_rays_area(const JsonReader& item, std::span<const InfluenceArea> areas, const SceneBounds& bounds) {
  if (item.is_text()) {
    std::vector<std::string_view> names;
    for (const InfluenceArea& area : areas) {
      if (area.name == item.text()) return area;
      names.push_back(area.name);
    }
    item.fail(ErrorCode::kMalformed, "there is no area \"" + item.text() + '"', suggestion(item.text(), names));
  }
  std::vector<InfluenceArea> described = read_area(item, bounds);
  if (described.size() != 1)
    item.fail(ErrorCode::kMalformed, "a light is six areas", "Name one of them under \"areas\"");
  return described[0];
}

AreaRays read_area_rays(const JsonReader& set, std::span<const InfluenceArea> areas, const SceneBounds& bounds) {
  constexpr std::array<std::string_view, 2> kStarts{"near", "random_depth"}, kSpreads{"near_plane", "angle"};
  AreaRays rays{read_rays_area(set.at("area"), areas, bounds)};
  if (const auto start = set.find("start"); start && start->choice(kStarts) == 1) rays.start = RayStart::kRandomDepth;
  if (const auto spread = set.find("spread"); spread && spread->choice(kSpreads) == 1)
    rays.spread = PointSpread::kAngle;
  rays.cone_degrees = set.number_or("cone_degrees", rays.cone_degrees);
  rays.jitter_radius = set.number_or("jitter_radius", rays.jitter_radius);
  set.with_place([&] { return cast_rays(rays, 0, 0); });  // checks
  return rays;
}

SurfaceRays read_surface_rays(const JsonReader& surface) {
  constexpr std::array<std::string_view, 3> kTargets{"direction", "point", "rectangle"};
  surface.expect_keys(kTargets);
  const std::string_view target = surface.one_of(kTargets);
  SurfaceRays rays;
  if (target == "direction") {
    rays.target = TowardsDirection{surface.at(target).vector()};
  } else if (target == "point") {
    rays.target = TowardsPoint{surface.at(target).vector()};
  } else {
    constexpr std::array<std::string_view, 3> kKeys{"center", "half_u", "half_v"};
    const JsonReader item = surface.at(target);
    item.expect_keys(kKeys);
    rays.target = TowardsRectangle{item.at("center").vector(), item.at("half_u").vector(), item.at("half_v").vector()};
  }
  surface.with_place([&] { return cast_rays(rays, TriangleMesh{}, 0, 0); });  // checks
  return rays;
}

CameraRays read_camera_rays(const JsonReader& camera) {
  constexpr std::array<std::string_view, 6> kKeys{"eye", "target", "up", "fov_y", "width", "height"};
  camera.expect_keys(kKeys);
  CameraRays rays;
  rays.eye = camera.at("eye").vector();
  rays.target = camera.at("target").vector();
  rays.up = camera.vector_or("up", rays.up);
  rays.fov_y = camera.number_or("fov_y", rays.fov_y);
  CameraRays one_pixel = rays;
  one_pixel.width = one_pixel.height = 1;
  camera.with_place([&] { return cast_rays(one_pixel); });  // checks
  rays.width = static_cast<uint32_t>(camera.at("width").whole_number(1, kMostPixels));
  rays.height = static_cast<uint32_t>(camera.at("height").whole_number(1, kMostPixels));
  return rays;
}

Ray read_ray(const JsonReader& item) {
  const std::vector<JsonReader> parts = item.items();
  if (parts.size() != 6 && parts.size() != 8)
    item.fail(ErrorCode::kMalformed, "this ray has " + std::to_string(parts.size()) + " numbers",
              "Write [ox, oy, oz, dx, dy, dz] or [ox, oy, oz, dx, dy, dz, tmin, tmax]; tmax may be null for no end");
  Ray ray{{parts[0].number(), parts[1].number(), parts[2].number()},
          {parts[3].number(), parts[4].number(), parts[5].number()}};
  if (parts.size() == 8) {
    ray.tmin = parts[6].number();
    if (!parts[7].is_null()) ray.tmax = parts[7].number();
  }
  return ray;
}

std::vector<Ray> read_rays(const JsonReader& list) {
  std::vector<Ray> rays;
  for (const JsonReader& item : list.items()) rays.push_back(read_ray(item));
  return rays;
}

std::vector<Ray> read_ray_file(const JsonReader& file) {
  const std::filesystem::path path = std::filesystem::path(file.path()).parent_path() / file.text();
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    file.fail(ErrorCode::kUnreadable, path.string() + " is no regular file");  // a pipe may never end
  return load_rays(path.string());
}

void expect_set_keys(const JsonReader& set, std::string_view source) {
  constexpr std::array<std::string_view, 8> kAreaKeys{"name",  "area",   "count",        "seed",
                                                      "start", "spread", "cone_degrees", "jitter_radius"};
  constexpr std::array<std::string_view, 4> kSurfaceKeys{"name", "surface", "count", "seed"};
  if (source == "area") return set.expect_keys(kAreaKeys);
  if (source == "surface") return set.expect_keys(kSurfaceKeys);
  const std::array<std::string_view, 2> fixed{"name", source};
  set.expect_keys(fixed);
}

RaySet read_ray_set(const JsonReader& set, std::span<const InfluenceArea> areas, const SceneBounds& bounds) {
  const std::string_view source = set.one_of(kSources);
  expect_set_keys(set, source);
  RaySet result{set.at("name").text(), std::vector<Ray>{}};
  if (source == "area") result.source = read_area_rays(set, areas, bounds);
  if (source == "surface") result.source = read_surface_rays(set.at(source));
  if (source == "camera") result.source = read_camera_rays(set.at(source));
  if (source == "rays") result.source = read_rays(set.at(source));
  if (source == "file") result.source = read_ray_file(set.at(source));
  if (const auto count = set.find("count")) result.count = count->whole_number(0, kMostRays);
  if (const auto seed = set.find("seed")) result.seed = seed->whole_number(0, kMostSeed);
  return result;
}

}  // namespace

std::vector<RaySet> read_ray_sets(const JsonReader& list, std::span<const InfluenceArea> areas,
                                  const SceneBounds& bounds) {
  std::vector<RaySet> sets;
  std::set<std::string> names;
  for (const JsonReader& item : list.items()) {
    RaySet set = read_ray_set(item, areas, bounds);
    if (!names.insert(set.name).second)
      item.fail(ErrorCode::kMalformed, "another ray set has the name \"" + set.name + '"', "Give each its own");
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace raygrain
