#include "trace/coverage_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "raygrain/ray_frame.h"

#include "base/random.h"

namespace raygrain {
namespace {

constexpr size_t kMostTriangles = 8192;  // that are looked at, evenly spread over the mesh
constexpr uint64_t kSeed = 1;
constexpr int kCoarse = 128, kFinePerCoarse = 32;  // directions of edges that are told apart
constexpr double kLeastSine = 0.25;                // of the angle between the grid's two directions
constexpr double kMostStretch = 4;                 // of its squares
constexpr double kMostTilt = 1.7;                  // of the plane from which depth is measured: about 60 degrees

double cross(Vec2d a, Vec2d b) {
  return a.x * b.y - a.y * b.x;
}

/// Edges of about the same direction together, signs aside: their sum, with y >= 0, and the number of that direction.
struct EdgeBundle {
  Vec2d sum;
  int number = 0;
};

/// Of `count` directions of the half-plane y >= 0, from +x to -x.
int direction_number(Vec2d edge, int count) {
  const double turn = 0.5 - 0.5 * edge.x / (std::abs(edge.x) + edge.y);
  return std::min(count - 1, static_cast<int>(turn * count));
}

std::vector<EdgeBundle> bundle(const std::vector<Vec2d>& edges, int count) {
  std::vector<EdgeBundle> bundles(static_cast<size_t>(count));
  for (const Vec2d edge : edges) {
    const int number = direction_number(edge, count);
    Vec2d& sum = bundles[static_cast<size_t>(number)].sum;
    sum = {sum.x + edge.x, sum.y + edge.y};
    bundles[static_cast<size_t>(number)].number = number;
  }
  std::erase_if(bundles, [](const EdgeBundle& one) { return one.sum == Vec2d{}; });
  return bundles;
}

using Corners = std::array<Vec3d, 3>;

/// All triangles, or of large meshes one of every few, in no pattern.
std::vector<Corners> sample_triangles(const TriangleMesh& mesh) {
  std::vector<Corners> sample;
  const size_t count = mesh.triangle_count(), step = (count + kMostTriangles - 1) / kMostTriangles;
  Random random(kSeed);
  for (size_t begin = 0; begin < count; begin += step) {
    const size_t id = begin + random.below(std::min(step, count - begin));
    sample.push_back({to_double(mesh.vertex(id, 0)), to_double(mesh.vertex(id, 1)), to_double(mesh.vertex(id, 2))});
  }
  return sample;
}

/// Across the rays, with y >= 0, and as long as they matter: those of triangles that the light grazes hardly do.
std::vector<Vec2d> edges_across(const std::vector<Corners>& triangles, const RayFrame& frame) {
  std::vector<Vec2d> edges;
  for (const Corners& p : triangles) {
    const Vec3d normal = raygrain::cross(p[1] - p[0], p[2] - p[0]);
    const double facing = dot(frame.rows[2], normal), square = dot(normal, normal);
    const double weight = square > 0 ? facing * facing / square : 0;
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d edge = (p[(i + 1) % 3] - p[i]) * weight;
      const Vec2d e{dot(frame.rows[0], edge), dot(frame.rows[1], edge)};
      if (e != Vec2d{}) edges.push_back(e.y < 0 ? Vec2d{-e.x, -e.y} : e);
    }
  }
  return edges;
}

/// Lines of a grid in one of its two directions. Edges cross them in proportion to `crossings`.
struct GridLines {
  Vec2d along;
  double crossings = 0;
  int number = -1;  // of the direction's bundle
};

GridLines lines_along(const EdgeBundle& direction, const std::vector<EdgeBundle>& edges) {
  const double size = std::sqrt(direction.sum.x * direction.sum.x + direction.sum.y * direction.sum.y);
  GridLines lines{{direction.sum.x / size, direction.sum.y / size}, 0, direction.number};
  for (const EdgeBundle& edge : edges) lines.crossings += std::abs(cross(lines.along, edge.sum));
  return lines;
}

/// How much longer than wide cells are, so that edges cross both kinds of lines as often.
double stretch(const GridLines& a, const GridLines& b) {
  const double more = std::max(a.crossings, b.crossings), less = std::min(a.crossings, b.crossings);
  return more < kMostStretch * less ? more / less : kMostStretch;
}

/// What edges cross of both, squared, with cells of the same area whatever the pair.
double price(const GridLines& a, const GridLines& b) {
  const double sine = std::abs(cross(a.along, b.along)), longer = stretch(a, b);
  if (sine < kLeastSine) return std::numeric_limits<double>::infinity();
  const double crossed = std::min(a.crossings, b.crossings) + std::max(a.crossings, b.crossings) / longer;
  return crossed * crossed * longer / sine;
}

struct GridPair {
  GridLines a{{1, 0}, 1}, b{{0, 1}, 1};
};

/// The best of all pairs along edges; where all are nearly along one line, the longest of them and what is across it.
GridPair choose_pair(const std::vector<EdgeBundle>& edges) {
  GridPair best;
  double least = std::numeric_limits<double>::infinity(), longest = 0;
  std::vector<GridLines> all;
  for (const EdgeBundle& edge : edges) {
    const GridLines& lines = all.emplace_back(lines_along(edge, edges));
    const double square = edge.sum.x * edge.sum.x + edge.sum.y * edge.sum.y;
    if (!(square > longest)) continue;
    longest = square;
    best = {lines, lines_along({{-edge.sum.y, edge.sum.x}, -1}, edges)};
  }
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (const double p = price(all[i], all[j]); p < least) least = p, best = {all[i], all[j]};
  return best;
}

/// The best beside `other` of the fine bundles in the coarse one of `lines` and next to it.
GridLines refine(const GridLines& lines, const GridLines& other, const std::vector<EdgeBundle>& fine) {
  GridLines best = lines;
  double least = std::numeric_limits<double>::infinity();
  for (const EdgeBundle& edge : fine) {
    const int apart = std::abs(edge.number / kFinePerCoarse - lines.number);
    if (apart > 1 && apart < kCoarse - 1) continue;
    const GridLines candidate = lines_along(edge, fine);
    if (const double p = price(candidate, other); p < least) least = p, best = candidate;
  }
  return best;
}

GridPair choose_lines(const std::vector<Vec2d>& edges) {
  const GridPair coarse = choose_pair(bundle(edges, kCoarse));
  if (coarse.a.number < 0 || coarse.b.number < 0) return coarse;  // nothing to be refined
  const std::vector<EdgeBundle> fine = bundle(edges, kCoarse * kFinePerCoarse);
  const GridLines a = refine(coarse.a, coarse.b, fine), b = refine(coarse.b, a, fine);
  return a.crossings < b.crossings ? GridPair{b, a} : GridPair{a, b};  // however the scene is turned
}

struct Weighted {
  double value, weight;
};

/// The value with as much weight before as after it; 0 of none.
double weighted_median(std::vector<Weighted>& all) {
  double before = 0;  // half of all weight, less what lies before `first`
  for (const Weighted& one : all) before += one.weight / 2;
  auto first = all.begin(), last = all.end();
  while (last - first > 1) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double left = 0;
    for (auto one = first; one != middle; ++one) left += one->weight;
    if (left > before)
      last = middle;
    else
      first = middle, before -= left;
  }
  return first == last ? 0 : first->value;
}

/// From a plane as steep as half of what the light sees, by area, so that cells of it are flat.
Vec3d depth_row(const std::vector<Corners>& triangles, const std::array<Vec3d, 3>& rows) {
  std::vector<Weighted> slopes_x, slopes_y;
  for (const Corners& p : triangles) {
    const Vec3d b = p[1] - p[0], c = p[2] - p[0];
    const Vec3d normal = raygrain::cross(Vec3d{dot(rows[0], b), dot(rows[1], b), dot(rows[2], b)},
                                         Vec3d{dot(rows[0], c), dot(rows[1], c), dot(rows[2], c)});
    if (!(normal.z * normal.z > 1e-20 * dot(normal, normal))) continue;  // a line to the light
    slopes_x.push_back({-normal.x / normal.z, std::abs(normal.z)});
    slopes_y.push_back({-normal.y / normal.z, std::abs(normal.z)});
  }
  const Vec3d tilt = rows[0] * weighted_median(slopes_x) + rows[1] * weighted_median(slopes_y);
  return normalized(rows[2] - tilt * (kMostTilt / std::max(length(tilt), kMostTilt)));
}

/// Is more of the mesh in the greater half of what it takes up along a row? Such rows are turned around, so that cells
/// come in the same order in memory however the scene is turned.
bool is_fuller_above(const std::vector<Corners>& triangles, Vec3d row) {
  if (triangles.empty()) return false;
  double lo = std::numeric_limits<double>::infinity(), hi = -lo, sum = 0;
  for (const Corners& p : triangles) {
    const double at = dot(row, p[0]);
    lo = std::min(lo, at), hi = std::max(hi, at);
    sum += at;
  }
  return sum / static_cast<double>(triangles.size()) > (lo + hi) / 2;
}

}  // namespace

ColumnMap choose_parallel_map(const TriangleMesh& mesh, Vec3 direction, Vec3 center) {
  const RayFrame frame = *parallel_frame(FrameKind::kRotation, direction, center);
  const std::vector<Corners> triangles = sample_triangles(mesh);
  const GridPair lines = choose_lines(edges_across(triangles, frame));
  const double longer = stretch(lines.a, lines.b);
  const auto row = [&](const GridLines& one, const GridLines& other) {
    const double size = one.crossings > other.crossings ? 1 / longer : 1;
    return frame.rows[0] * (-one.along.y * size) + frame.rows[1] * (one.along.x * size);
  };
  ColumnMap map;
  map.rows = {row(lines.a, lines.b), row(lines.b, lines.a), -frame.rows[2]};
  map.rows[2] = depth_row(triangles, map.rows);
  map.center = center;
  for (size_t i = 0; i < 2; ++i)
    if (is_fuller_above(triangles, map.rows[i])) map.rows[i] = -map.rows[i];
  return map;
}

}  // namespace raygrain
