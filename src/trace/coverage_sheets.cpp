#include "trace/coverage_sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace raygrain {
namespace {

constexpr float kNone = -std::numeric_limits<float>::infinity();

/// The first vertex at the same place, for each.
std::vector<uint32_t> weld(const std::vector<Vec3>& vertices) {
  std::vector<uint32_t> order(vertices.size()), welded(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](uint32_t i, uint32_t j) {
    const Vec3 a = vertices[i], b = vertices[j];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z != b.z ? a.z < b.z : i < j;
  };
  std::sort(order.begin(), order.end(), less);
  for (size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? welded[order[i - 1]] : order[i];
  return welded;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> find_neighbours(const TriangleMesh& mesh) {
  struct Edge {
    uint64_t ends;
    uint32_t triangle, number;
  };
  const std::vector<uint32_t> welded = weld(mesh.vertices);
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangle_count());
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (uint32_t i = 0; i < 3; ++i) {
      const uint64_t a = welded[mesh.triangles[t][i]], b = welded[mesh.triangles[t][(i + 1) % 3]];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, i});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.ends != b.ends           ? a.ends < b.ends
           : a.triangle != b.triangle ? a.triangle < b.triangle
                                      : a.number < b.number;
  });
  std::vector<std::array<uint32_t, 3>> neighbours(mesh.triangle_count(), {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].ends == edges[begin].ends) ++end;
    if (end - begin != 2) continue;
    const Edge &a = edges[begin], &b = edges[begin + 1];
    neighbours[a.triangle][a.number] = b.triangle;
    neighbours[b.triangle][b.number] = a.triangle;
  }
  return neighbours;
}

uint32_t SheetFinder::root(uint32_t i) {
  while (parts_[i].parent != i) i = parts_[i].parent = parts_[parts_[i].parent].parent;
  return i;
}

/// Unites triangles across the edges that the cell may meet.
void SheetFinder::join_neighbours(std::span<const SeenTriangle> tile, std::span<const InCell> list,
                                  const CellSquare& cell) {
  ++cell_number_;
  for (uint32_t i = 0; i < list.size(); ++i) {
    const uint32_t id = tile[list[i].slot].record.id;
    slot_of_[id] = i;
    seen_in_[id] = cell_number_;
    parts_[i] = {i, false, false, list[i].lowest};
  }
  for (uint32_t i = 0; i < list.size(); ++i) {
    const SeenTriangle& seen = tile[list[i].slot];
    for (size_t e = 0; e < 3; ++e) {
      if (!seen.edge_may_touch(e, cell.x, cell.y, cell.half)) continue;
      const uint32_t other = neighbours_[seen.record.id][e];
      if (other == kNoNeighbour || seen_in_[other] != cell_number_)
        parts_[i].is_open = true;
      else
        parts_[root(i)].parent = root(slot_of_[other]);
    }
  }
}

/// How often each part covers one point of the cell, which stands for all of them.
void SheetFinder::find_parity(std::span<const SeenTriangle> tile, std::span<const InCell> list,
                              const CellSquare& cell) {
  const double x = cell.x + 0.31 * cell.half, y = cell.y + 0.17 * cell.half;  // off the lines of regular models
  for (uint32_t i = 0; i < list.size(); ++i) {
    Part& part = parts_[root(i)];
    if (part.is_open) continue;
    const SeenTriangle& seen = tile[list[i].slot];
    if (seen.fills(x, y, 0))
      part.is_odd = !part.is_odd;
    else if (seen.may_touch(x, y, 0))
      part.is_open = true;
  }
}

float SheetFinder::cover(std::span<const SeenTriangle> tile, std::span<const InCell> list, const CellSquare& cell) {
  float best = kNone;
  for (const InCell& one : list)
    if (one.lowest > best && tile[one.slot].fills(cell.x, cell.y, cell.half)) best = one.lowest;
  if (list.size() < 2 || list.size() > kMostTriangles) return best;
  parts_.resize(list.size());
  join_neighbours(tile, list, cell);
  for (uint32_t i = 0; i < list.size(); ++i) {
    Part& part = parts_[root(i)];
    part.is_open |= parts_[i].is_open;
    part.lowest = std::min(part.lowest, list[i].lowest);
  }
  find_parity(tile, list, cell);
  for (uint32_t i = 0; i < list.size(); ++i)
    if (const Part& part = parts_[i]; part.parent == i && !part.is_open && part.is_odd)
      best = std::max(best, part.lowest);
  return best;
}

}  // namespace raygrain
