// Which triangles share which edges.
#include <algorithm>
#include <bit>
#include <numeric>
#include <span>

#include "base/sort_few.h"
#include "trace/coverage_grid.h"

namespace raygrain {
namespace {

/// The first vertex at the same place, for each: by a table of places, open to the next free entry.
std::vector<uint32_t> weld(const std::vector<Vec3>& vertices) {
  constexpr uint32_t kFree = 0xffffffffu;
  const size_t size = std::bit_ceil(std::max<size_t>(2 * vertices.size(), 16));
  std::vector<uint32_t> table(size, kFree), welded(vertices.size());
  for (uint32_t i = 0; i < vertices.size(); ++i) {
    const Vec3 p = vertices[i] + Vec3{};  // no negative zeros
    uint64_t hash = 0;
    for (const float x : {p.x, p.y, p.z}) hash = (hash ^ std::bit_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15u;
    size_t at = (hash ^ hash >> 32) & (size - 1);
    while (table[at] != kFree && vertices[table[at]] != vertices[i]) at = (at + 1) & (size - 1);
    if (table[at] == kFree) table[at] = i;
    welded[i] = table[at];
  }
  return welded;
}

struct Edge {
  uint32_t other;             // the greater end
  uint32_t triangle, number;  // of the edge in the triangle
};

}  // namespace

MeshNeighbours find_neighbours(const TriangleMesh& mesh) {
  const std::vector<uint32_t> welded = weld(mesh.vertices);
  const auto visit_edges = [&](const auto& visit) {
    for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t a = welded[mesh.triangles[t][i]], b = welded[mesh.triangles[t][(i + 1) % 3]];
        visit(std::min(a, b), Edge{std::max(a, b), t, i});
      }
  };
  // By their lesser ends, then, a few at a time, by the others.
  std::vector<uint32_t> begin(mesh.vertices.size() + 2);
  visit_edges([&](uint32_t end, const Edge&) { ++begin[end + 2]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Edge> edges(3 * mesh.triangle_count());
  visit_edges([&](uint32_t end, const Edge& edge) { edges[begin[end + 1]++] = edge; });

  MeshNeighbours neighbours(mesh.triangle_count(), {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const std::span<Edge> fan = std::span(edges).subspan(begin[vertex], begin[vertex + 1] - begin[vertex]);
    // Those that share both ends keep their order: by triangles.
    sort_few(fan, [](const Edge& a, const Edge& b) { return a.other < b.other; });
    for (size_t i = 0, end = 0; i < fan.size(); i = end) {
      while (end < fan.size() && fan[end].other == fan[i].other) ++end;
      if (end - i != 2) continue;
      neighbours[fan[i].triangle][fan[i].number] = fan[i + 1].triangle;
      neighbours[fan[i + 1].triangle][fan[i + 1].number] = fan[i].triangle;
    }
  }
  return neighbours;
}

}  // namespace raygrain
