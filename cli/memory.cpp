#include "cli/memory.h"

#include <algorithm>

#include <fmt/format.h>

#include "raygrain/error.h"

#include "base/memory.h"

namespace raygrain::cli {

namespace {

// Bytes a triangle, measured on a terrain of 980,000 triangles (peak of the process, less the mesh).
constexpr double kSubset = 190, kBinned = 210, kSpatial = 250;  // a builder, with its log and the finished tree
constexpr double kArea = 300;        // the local tree in both forms and the coverage, beside the global tree
constexpr double kInRaySpace = 260;  // its tree in ray space besides, with the corners
constexpr double kKeptTree = 100;    // one of several finished trees

double bytes_per_triangle(const std::string& builder) {
  if (builder == "subset") return kSubset;
  return builder == "spatial" ? kSpatial : kBinned;
}

/// The part of the triangles that belong to an area.
double share_of(const TriangleMesh& mesh, const InfluenceArea& area) {
  constexpr size_t kSample = 10000;
  const AreaGeometry geometry(area);
  const size_t step = std::max<size_t>(1, mesh.triangle_count() / kSample);
  size_t members = 0, asked = 0;
  for (size_t i = 0; i < mesh.triangle_count(); i += step, ++asked)
    members += overlaps(geometry.region(), mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)) ? 1 : 0;
  return asked > 0 ? static_cast<double>(members) / static_cast<double>(asked) : 0;
}

double count_of(const TriangleMesh& mesh) {
  return static_cast<double>(mesh.triangle_count());
}

double members_of(const TriangleMesh& mesh, std::span<const InfluenceArea> areas) {
  double shares = 0;
  for (const InfluenceArea& area : areas) shares += share_of(mesh, area);
  return shares * count_of(mesh);
}

std::string gibibytes(double bytes) {
  return fmt::format("{:.1f} GiB", bytes / (1 << 30));
}

}  // namespace

void require_memory(const std::string& what, double bytes, const std::string& hint) {
  constexpr double kNobodyCares = 64 << 20;
  if (bytes < kNobodyCares) return;
  const auto left = static_cast<double>(available_memory());
  if (bytes > left)
    throw Error(ErrorCode::kLimit, what,
                "needs about " + gibibytes(bytes) + " of memory, and " + gibibytes(left) + " are left", hint);
}

double bytes_of_tree(const TriangleMesh& mesh, const InfluenceArea* area, const Recipe& recipe) {
  const double triangles = area ? share_of(mesh, *area) * count_of(mesh) : count_of(mesh);
  return triangles * bytes_per_triangle(recipe.builder);
}

double bytes_of_accelerator(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                            const AcceleratorOptions& options) {
  const std::string builder = options.quality ? builder_name(*options.quality) : options.global.builder;
  const double area = local_space(options) == LocalSpace::kRay ? kArea + kInRaySpace : kArea;
  const double copy = static_cast<double>(mesh.vertices.size() * sizeof(Vec3) + mesh.triangles.size() * 12);
  return copy + count_of(mesh) * bytes_per_triangle(builder) + members_of(mesh, areas) * area;
}

double bytes_of_comparison(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                           std::span<const Recipe> recipes) {
  double build = kBinned;
  for (const Recipe& recipe : recipes) build = std::max(build, bytes_per_triangle(recipe.builder));
  const double kept = kKeptTree * static_cast<double>(std::max<size_t>(recipes.size(), 1));
  return count_of(mesh) * kBinned + members_of(mesh, areas) * (build + kept);
}

}  // namespace raygrain::cli
