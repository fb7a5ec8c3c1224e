#include <cmath>

#include "io/scene_json.h"
#include "io/text.h"

namespace raygrain {
namespace {

// Sizes are written so that the same float is read back: the shortest digits, and -0.0 with its point, since JSON's -0
// is a whole number without sign.
std::string number(float value) {
  if (value == 0) return std::signbit(value) ? "-0.0" : "0";
  std::string text;
  append_float(text, value);
  return text;
}

std::string vector(Vec3 v) {
  return '[' + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ']';
}

// The members of one object: ObjectText().add("a", "1").add("b", "[]").text().
class ObjectText {
 public:
  ObjectText& add(std::string_view key, const std::string& value) {
    members_.append(members_.empty() ? "\"" : ", \"").append(key).append("\": ").append(value);
    return *this;
  }
  std::string text() const { return '{' + members_ + '}'; }

 private:
  std::string members_;
};

void add_shape(ObjectText& object, const PlaneArea& area) {
  object.add("plane", ObjectText()
                          .add("center", vector(area.center))
                          .add("direction", vector(area.direction))
                          .add("up", vector(area.up))
                          .add("half_width", number(area.half_width))
                          .add("half_height", number(area.half_height))
                          .add("depth", number(area.depth))
                          .text());
}

void add_shape(ObjectText& object, const PointArea& area) {
  object.add("point", ObjectText()
                          .add("eye", vector(area.eye))
                          .add("forward", vector(area.forward))
                          .add("up", vector(area.up))
                          .add("fov_x", number(area.fov_x))
                          .add("fov_y", number(area.fov_y))
                          .add("near_z", number(area.near_z))
                          .add("far_z", number(area.far_z))
                          .text());
}

std::string area_text(const InfluenceArea& area) {
  ObjectText object;
  object.add("name", json_text(area.name));
  std::visit([&](const auto& shape) { add_shape(object, shape); }, area.shape);
  return object.add("tolerance", number(area.tolerance)).text();
}

// By its name where the scene has the very same area, in full otherwise.
std::string area_reference(const InfluenceArea& area, const Scene& scene) {
  std::string text = area_text(area);
  for (const InfluenceArea& other : scene.areas)
    if (other.name == area.name) return area_text(other) == text ? json_text(area.name) : text;
  return text;
}

void add_source(ObjectText& object, const AreaRays& rays, const RaySet& set, const Scene& scene) {
  object.add("area", area_reference(rays.area, scene))
      .add("count", std::to_string(set.count))
      .add("seed", std::to_string(set.seed))
      .add("start", rays.start == RayStart::kNear ? "\"near\"" : "\"random_depth\"")
      .add("spread", rays.spread == PointSpread::kNearPlane ? "\"near_plane\"" : "\"angle\"")
      .add("cone_degrees", number(rays.cone_degrees))
      .add("jitter_radius", number(rays.jitter_radius));
}

std::string target_text(const TowardsDirection& target) {
  return ObjectText().add("direction", vector(target.direction)).text();
}
std::string target_text(const TowardsPoint& target) {
  return ObjectText().add("point", vector(target.point)).text();
}
std::string target_text(const TowardsRectangle& target) {
  ObjectText rectangle;
  rectangle.add("center", vector(target.center))
      .add("half_u", vector(target.half_u))
      .add("half_v", vector(target.half_v));
  return ObjectText().add("rectangle", rectangle.text()).text();
}

void add_source(ObjectText& object, const SurfaceRays& rays, const RaySet& set, const Scene&) {
  object.add("surface", std::visit([](const auto& target) { return target_text(target); }, rays.target))
      .add("count", std::to_string(set.count))
      .add("seed", std::to_string(set.seed));
}

void add_source(ObjectText& object, const CameraRays& rays, const RaySet&, const Scene&) {
  object.add("camera", ObjectText()
                           .add("eye", vector(rays.eye))
                           .add("target", vector(rays.target))
                           .add("up", vector(rays.up))
                           .add("fov_y", number(rays.fov_y))
                           .add("width", std::to_string(rays.width))
                           .add("height", std::to_string(rays.height))
                           .text());
}

std::string ray_text(const Ray& ray) {
  std::string text = "[";
  for (const Vec3 v : {ray.origin, ray.direction}) text += number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ", ";
  return text + number(ray.tmin) + ", " + (ray.tmax == kInf ? "null" : number(ray.tmax)) + ']';
}

template <class Item, class Write>
std::string list_text(const std::vector<Item>& items, const std::string& indent, const Write& write) {
  if (items.empty()) return "[]";
  std::string text;
  for (const Item& item : items) text += (text.empty() ? "[\n" : ",\n") + indent + write(item);
  return text + "\n" + indent.substr(2) + ']';
}

void add_source(ObjectText& object, const std::vector<Ray>& rays, const RaySet&, const Scene&) {
  object.add("rays", list_text(rays, "      ", ray_text));
}

std::string ray_set_text(const RaySet& set, const Scene& scene, const std::string& file) {
  ObjectText object;
  object.add("name", json_text(set.name));
  if (!file.empty()) return object.add("file", json_text(file)).text();
  std::visit([&](const auto& source) { add_source(object, source, set, scene); }, set.source);
  return object.text();
}

}  // namespace

std::string scene_json(const Scene& scene, const std::string& mesh_file, const std::vector<std::string>& ray_files) {
  const std::string head = "{\n  \"format\": \"raygrain-scene\",\n  \"version\": 1,\n";
  const auto write_set = [&](const RaySet& set) {
    return ray_set_text(set, scene, ray_files.at(static_cast<size_t>(&set - scene.ray_sets.data())));
  };
  return head + "  \"name\": " + json_text(scene.name) + ",\n  \"meshes\": [{\"file\": " + json_text(mesh_file) +
         "}],\n  \"areas\": " + list_text(scene.areas, "    ", area_text) +
         ",\n  \"rays\": " + list_text(scene.ray_sets, "    ", write_set) + "\n}\n";
}

}  // namespace raygrain
