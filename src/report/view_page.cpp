// The viewer's page filled with a scene: a JSON text that says what there is, and lines of packed arrays.
#include <cmath>

#include "raygrain/area.h"
#include "raygrain/error.h"
#include "raygrain/view.h"

#include "report/page_template.h"
#include "report/view_tree.h"

namespace raygrain {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDataPlace = "@RAYGRAIN_VIEW@", kBlobPlace = "@RAYGRAIN_BLOBS@";
constexpr size_t kLargestPage = 400'000'000;  // browsers hold no longer texts than half a gigabyte
constexpr PageKind kViewer{"viewer page", "viewer"};

Json vector_json(Vec3d v) {
  return {v.x, v.y, v.z};
}

Json area_json(const InfluenceArea& area) {
  const AreaGeometry geometry(area);
  const Frame& frame = geometry.frame();
  const ConvexRegion& region = geometry.region();
  Json planes = Json::array(), corners = Json::array();
  for (const Plane& plane : region.planes)
    planes.push_back({plane.normal.x, plane.normal.y, plane.normal.z, plane.offset});
  for (const Vec3d corner : region.corners) corners.push_back(vector_json(corner));
  const auto* point = std::get_if<PointArea>(&area.shape);
  const float far_z = point ? point->far_z : std::get<PlaneArea>(area.shape).depth;
  return {{"name", area.name},
          {"kind", point ? "point" : "plane"},
          {"origin", vector_json(frame.origin)},
          {"right", vector_json(frame.right)},
          {"up", vector_json(frame.up)},
          {"forward", vector_json(frame.forward)},
          {"half", {geometry.window_half().x, geometry.window_half().y}},
          {"near", point ? static_cast<double>(point->near_z) : 0.0},
          {"far", static_cast<double>(far_z)},
          {"tolerance", static_cast<double>(area.tolerance)},
          {"slack", region.slack},
          {"planes", std::move(planes)},
          {"corners", std::move(corners)}};
}

Json pack_mesh(const TriangleMesh& mesh, std::string& lines) {
  ViewBlob blob;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    values.reserve(mesh.vertices.size());
    for (const Vec3 vertex : mesh.vertices) values.push_back(vertex[axis]);
    constexpr const char* kNames[] = {"x", "y", "z"};
    blob.add_floats(kNames[axis], values);
  }
  std::vector<uint32_t> corners;
  corners.reserve(3 * mesh.triangle_count());
  for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  blob.add_whole("corners", corners);
  return blob.write_to(lines);
}

Json pack_top_level(const Scene& scene, const TopLevelOptions& options, std::string& lines) {
  std::vector<ConvexRegion> regions;
  for (const InfluenceArea& area : scene.areas) regions.push_back(AreaGeometry(area).region());
  const TopLevel top(regions, options);
  std::vector<float> boxes;
  std::vector<uint32_t> children, counts, lists;
  for (const TopLevel::Node& node : top.nodes()) {
    for (const Vec3 end : {node.bounds.lo, node.bounds.hi}) boxes.insert(boxes.end(), {end.x, end.y, end.z});
    children.push_back(node.first_child);
    const bool leaf = node.first_child == 0;
    const std::span<const uint32_t> list = leaf ? top.regions_at(center(node.bounds)) : std::span<const uint32_t>{};
    counts.push_back(static_cast<uint32_t>(list.size()));
    lists.insert(lists.end(), list.begin(), list.end());
  }
  ViewBlob blob;
  blob.add_floats("boxes", boxes);
  blob.add_whole("children", children);
  blob.add_whole("counts", counts);
  blob.add_whole("lists", lists);
  return blob.write_to(lines);
}

Json values_json(const FieldValues& values) {
  Json list = Json::array();
  for (size_t i = 0; i < fields().size(); ++i) {
    const Field& about = fields()[i];
    if (!values.has(FieldId{i}) || !about.deterministic) continue;
    list.push_back(
        {{"name", about.name}, {"unit", about.unit}, {"value", values[FieldId{i}]}, {"meaning", about.meaning}});
  }
  return list;
}

Json tree_json(const ViewTree& tree, const Scene& scene, std::span<const Bounds> triangles, std::string& lines) {
  const std::string where = "tree " + tree.recipe;
  if (!tree.tree || tree.tree->nodes.empty()) throw Error(ErrorCode::kUsage, where, "has no nodes", "Build it first");
  if (tree.area != kWholeScene && tree.area >= scene.areas.size())
    throw Error(ErrorCode::kUsage, where, "belongs to no area of the scene", "Give the index of an area");
  return {{"recipe", tree.recipe},
          {"area", tree.area == kWholeScene ? Json(-1) : Json(tree.area)},
          {"nodes", tree.tree->nodes.size()},
          {"total", tree.measure.total(tree.tree->nodes[0].bounds)},
          {"values", values_json(tree.values)},
          {"data", pack_tree(tree, triangles).write_to(lines)}};
}

}  // namespace

bool is_view_page(const std::string& page) {
  return page.find(R"({"format":"raygrain-view","version":)") != std::string::npos;
}

std::string view_page(const Scene& scene, std::span<const ViewTree> trees, const ViewOptions& options,
                      const std::string& page, const std::string& path) {
  std::string lines;
  Json areas = Json::array(), tree_list = Json::array();
  for (const InfluenceArea& area : scene.areas) areas.push_back(area_json(area));
  const std::vector<Bounds> triangles = triangle_bounds(scene.mesh);
  Json mesh = pack_mesh(scene.mesh, lines);
  for (const ViewTree& tree : trees) tree_list.push_back(tree_json(tree, scene, triangles, lines));
  const Json data{{"format", "raygrain-view"},
                  {"version", 1},
                  {"scene", scene.name},
                  {"triangles", scene.mesh.triangle_count()},
                  {"vertices", scene.mesh.vertices.size()},
                  {"seed", std::to_string(options.seed)},
                  {"costs", {{"inner", options.costs.inner}, {"triangle", options.costs.triangle}}},
                  {"mesh", std::move(mesh)},
                  {"areas", std::move(areas)},
                  {"trees", std::move(tree_list)},
                  {"topLevel", pack_top_level(scene, options.top_level, lines)}};
  if (lines.size() > kLargestPage)
    throw Error(ErrorCode::kLimit, "view of " + scene.name,
                "is too large for a browser: " + std::to_string(lines.size() / 1'000'000) + " MB",
                "Show fewer recipes or areas, or a smaller scene");
  const std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string with_blobs =
      filled_page(page, kBlobPlace, lines, kViewer, path);  // they hold no place, texts might
  return filled_page(with_blobs, kDataPlace, script_safe(text), kViewer, path);
}

}  // namespace raygrain
