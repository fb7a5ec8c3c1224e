#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/trigonometry.h"
#include "io/scene_json.h"

namespace raygrain {
namespace {

// Columns x, y, z and the translation.
struct Placement {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3d turned(Vec3d v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d operator()(Vec3d p) const { return turned(p) + origin; }
};

// Rodrigues' formula, for an axis of unit length.
Vec3d rotated(Vec3d v, Vec3d axis, const SineCosine& angle) {
  return v * angle.cosine + cross(axis, v) * angle.sine + axis * (dot(axis, v) * (1 - angle.cosine));
}

Vec3d read_scale(const JsonReader& scale) {
  const Vec3d value =
      to_double(scale.is_number() ? Vec3{scale.number(), scale.number(), scale.number()} : scale.vector());
  if (value.x == 0 || value.y == 0 || value.z == 0)
    scale.fail(ErrorCode::kMalformed, "a scale of 0 leaves nothing", "Choose 1 to leave the size as it is");
  return value;
}

Placement read_rotation(const JsonReader& rotate) {
  constexpr std::array<std::string_view, 2> kKeys{"axis", "degrees"};
  rotate.expect_keys(kKeys);
  const Vec3 axis = rotate.at("axis").vector();
  if (axis == Vec3{}) rotate.fail(ErrorCode::kMalformed, "the axis is zero", "Write [0, 1, 0] to turn around y");
  const float degrees = rotate.at("degrees").number();
  if (!(std::abs(degrees) <= 360)) rotate.fail(ErrorCode::kMalformed, "degrees is out of range", "Choose -360 to 360");
  const Vec3d unit = normalized(to_double(axis));
  const SineCosine angle = sine_cosine(radians(static_cast<double>(degrees)));
  return {rotated({1, 0, 0}, unit, angle), rotated({0, 1, 0}, unit, angle), rotated({0, 0, 1}, unit, angle), {}};
}

// Rows of four numbers: three, or four of which the last is 0 0 0 1.
Placement read_matrix(const JsonReader& matrix) {
  const std::vector<JsonReader> cells = matrix.items();
  if (cells.size() != 12 && cells.size() != 16)
    matrix.fail(ErrorCode::kMalformed, "this has " + std::to_string(cells.size()) + " numbers, not 12 or 16",
                "Write the matrix row by row");
  std::array<double, 16> m{};
  for (size_t i = 0; i < cells.size(); ++i) m[i] = static_cast<double>(cells[i].number());
  if (cells.size() == 16 && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1))
    matrix.fail(ErrorCode::kMalformed, "the last row is not 0 0 0 1",
                "Perspective is not for meshes; write row by row");
  return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
}

Placement read_placement(const JsonReader& mesh) {
  if (const auto matrix = mesh.find("matrix")) {
    for (const std::string_view other : {"scale", "rotate", "translate"})
      if (mesh.has(other))
        mesh.fail(ErrorCode::kMalformed, "both \"matrix\" and \"" + std::string(other) + "\" are given",
                  "The matrix holds all");
    return read_matrix(*matrix);
  }
  Placement placement;
  if (const auto rotate = mesh.find("rotate")) placement = read_rotation(*rotate);
  if (const auto scale = mesh.find("scale")) {
    const Vec3d factor = read_scale(*scale);  // applied first
    placement.x = placement.x * factor.x;
    placement.y = placement.y * factor.y;
    placement.z = placement.z * factor.z;
  }
  placement.origin = to_double(mesh.vector_or("translate", {}));
  return placement;
}

bool is_moved(const JsonReader& mesh) {
  return mesh.has("matrix") || mesh.has("scale") || mesh.has("rotate") || mesh.has("translate");
}

TriangleMesh read_mesh(const JsonReader& item, const LoadOptions& options, LoadReport& report) {
  constexpr std::array<std::string_view, 5> kKeys{"file", "scale", "rotate", "translate", "matrix"};
  item.expect_keys(kKeys);
  const Placement placement = read_placement(item);
  const std::string file = (std::filesystem::path(item.path()).parent_path() / item.at("file").text()).string();
  LoadReport found;
  TriangleMesh mesh = load_mesh(file, options, &found);
  report.dropped_lines += found.dropped_lines;
  report.dropped_points += found.dropped_points;
  if (!is_moved(item)) return mesh;
  for (Vec3& vertex : mesh.vertices) vertex = to_float(placement(to_double(vertex)));
  validate(mesh, item.where());
  return mesh;
}

void append(TriangleMesh& whole, const TriangleMesh& part, const JsonReader& item) {
  constexpr size_t kMost = std::numeric_limits<uint32_t>::max();
  if (part.vertices.size() > kMost - whole.vertices.size() || part.triangles.size() > kMost - whole.triangles.size())
    item.fail(ErrorCode::kLimit, "more than 2^32 - 1 vertices or triangles in all");
  const auto first = static_cast<uint32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

TriangleMesh read_meshes(const JsonReader& meshes, const LoadOptions& options, LoadReport& report) {
  const std::vector<JsonReader> items = meshes.items();
  if (items.empty()) meshes.fail(ErrorCode::kMalformed, "there is no mesh", "Write [{\"file\": \"model.ply\"}]");
  TriangleMesh whole = read_mesh(items[0], options, report);
  for (size_t i = 1; i < items.size(); ++i) append(whole, read_mesh(items[i], options, report), items[i]);
  return whole;
}

}  // namespace raygrain
