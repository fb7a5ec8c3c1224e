#include <array>
#include <set>

#include "io/scene_json.h"

namespace raygrain {
namespace {

constexpr std::array<std::string_view, 5> kForms{"plane", "point", "sun", "light", "camera"};
constexpr std::array<std::string_view, 7> kAreaKeys{"name", "tolerance", "plane", "point", "sun", "light", "camera"};

PlaneArea read_plane(const JsonReader& plane) {
  constexpr std::array<std::string_view, 6> kKeys{"center", "direction", "up", "half_width", "half_height", "depth"};
  plane.expect_keys(kKeys);
  PlaneArea area;
  area.center = plane.at("center").vector();
  area.direction = plane.at("direction").vector();
  area.up = plane.vector_or("up", area.up);
  area.half_width = plane.at("half_width").number();
  area.half_height = plane.at("half_height").number();
  area.depth = plane.at("depth").number();
  return area;
}

PointArea read_point(const JsonReader& point) {
  constexpr std::array<std::string_view, 7> kKeys{"eye", "forward", "up", "fov_x", "fov_y", "near_z", "far_z"};
  point.expect_keys(kKeys);
  PointArea area;
  area.eye = point.at("eye").vector();
  area.forward = point.at("forward").vector();
  area.up = point.vector_or("up", area.up);
  area.fov_x = point.at("fov_x").number();
  area.fov_y = point.at("fov_y").number();
  area.near_z = point.at("near_z").number();
  area.far_z = point.at("far_z").number();
  return area;
}

InfluenceArea read_sun(const JsonReader& sun, const std::string& name, const SceneBounds& bounds) {
  constexpr std::array<std::string_view, 1> kKeys{"direction"};
  sun.expect_keys(kKeys);
  const Vec3 direction = sun.at("direction").vector();
  return sun.with_place([&] { return directional_light_area(name, direction, bounds()); });
}

std::vector<InfluenceArea> read_light(const JsonReader& light, const std::string& name, const SceneBounds& bounds) {
  constexpr std::array<std::string_view, 1> kKeys{"position"};
  light.expect_keys(kKeys);
  const Vec3 position = light.at("position").vector();
  return light.with_place([&] { return point_light_areas(name, position, bounds()); });
}

InfluenceArea read_camera(const JsonReader& camera, const std::string& name, const SceneBounds& bounds) {
  constexpr std::array<std::string_view, 4> kKeys{"eye", "target", "fov_y", "aspect"};
  camera.expect_keys(kKeys);
  const Vec3 eye = camera.at("eye").vector(), target = camera.at("target").vector();
  const float fov_y = camera.at("fov_y").number(), aspect = camera.number_or("aspect", 1);
  return camera.with_place([&] { return camera_area(name, eye, target, fov_y, aspect, bounds()); });
}

std::vector<InfluenceArea> read_form(const JsonReader& item, const std::string& name, const SceneBounds& bounds) {
  const std::string_view form = item.one_of(kForms);
  const JsonReader shape = item.at(form);
  if (form == "plane") return {{name, read_plane(shape)}};
  if (form == "point") return {{name, read_point(shape)}};
  if (form == "sun") return {read_sun(shape, name, bounds)};
  if (form == "light") return read_light(shape, name, bounds);
  return {read_camera(shape, name, bounds)};
}

}  // namespace

std::vector<InfluenceArea> read_area(const JsonReader& item, const SceneBounds& bounds) {
  item.expect_keys(kAreaKeys);
  std::vector<InfluenceArea> areas = read_form(item, item.at("name").text(), bounds);
  for (InfluenceArea& area : areas) {
    area.tolerance = item.number_or("tolerance", area.tolerance);
    validate(area, item.where());
  }
  return areas;
}

std::vector<InfluenceArea> read_areas(const JsonReader& list, const SceneBounds& bounds) {
  std::vector<InfluenceArea> areas;
  std::set<std::string> names;
  for (const JsonReader& item : list.items())
    for (InfluenceArea& area : read_area(item, bounds)) {
      if (!names.insert(area.name).second)
        item.fail(ErrorCode::kMalformed, "another area has the name \"" + area.name + '"', "Give each its own");
      areas.push_back(std::move(area));
    }
  return areas;
}

}  // namespace raygrain
