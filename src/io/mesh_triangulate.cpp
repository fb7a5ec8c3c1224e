// Polygons to triangles. Ear clipping after Meisters, "Polygons have ears", 1975.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <unordered_map>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"

namespace raygrain {

namespace {

constexpr size_t kMaxConcaveCorners = 20000;

struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the signed area of a triangle: positive where it turns left.
double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Newell's normal: the direction from which a polygon shows its largest area.
Vec3d polygon_normal(const std::vector<Vec3>& vertices, std::span<const uint32_t> polygon) {
  Vec3d normal;
  const Vec3d base = to_double(vertices[polygon[0]]);
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    normal = normal + cross(to_double(vertices[polygon[i]]) - base, to_double(vertices[polygon[i + 1]]) - base);
  return normal;
}

/// The polygon in the coordinate plane that shows it largest, counter-clockwise; empty if it has no area.
std::vector<Point> projected(const std::vector<Vec3>& vertices, std::span<const uint32_t> polygon) {
  const Vec3d normal = polygon_normal(vertices, polygon);
  const Vec3d size{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  std::vector<Point> points;
  if (!(size[axis] > 0)) return points;
  const int u = normal[axis] > 0 ? (axis + 1) % 3 : (axis + 2) % 3, v = 3 - axis - u;
  for (const uint32_t index : polygon) points.push_back({vertices[index][u], vertices[index][v]});
  return points;
}

bool is_convex(const std::vector<Point>& points) {
  for (size_t i = 0; i < points.size(); ++i)
    if (turn(points[i], points[(i + 1) % points.size()], points[(i + 2) % points.size()]) < 0) return false;
  return true;
}

/// Cuts ears off a polygon that is not convex.
class EarCutter {
 public:
  explicit EarCutter(const std::vector<Point>& points) : points_(points), left_(points.size()) {
    for (size_t i = 0; i < left_.size(); ++i) left_[i] = static_cast<uint32_t>(i);
  }

  /// Calls emit(a, b, c), numbers of corners, n - 2 times.
  template <class Emit>
  void cut(const Emit& emit) {
    size_t from = 0;
    while (left_.size() > 3) {
      const size_t ear = find_ear(from);
      emit(before(ear), left_[ear], after(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      from = ear;  // going on behind the ear keeps the triangles from all meeting in one corner
    }
    emit(left_[0], left_[1], left_[2]);
  }

 private:
  uint32_t before(size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  uint32_t after(size_t i) const { return left_[(i + 1) % left_.size()]; }

  /// The first ear from `from` on; without one, a corner that cuts off no area; without that, any.
  size_t find_ear(size_t from) const {
    size_t flat = left_.size();
    for (size_t step = 0; step < left_.size(); ++step) {
      const size_t i = (from + step) % left_.size();
      const double area = turn(points_[before(i)], points_[left_[i]], points_[after(i)]);
      if (area > 0 && is_free(i)) return i;
      if (area == 0 && flat == left_.size()) flat = i;
    }
    return flat < left_.size() ? flat : from % left_.size();
  }

  /// No other corner lies in the triangle that corner `i` would cut off.
  bool is_free(size_t i) const {
    const Point a = points_[before(i)], b = points_[left_[i]], c = points_[after(i)];
    return std::none_of(left_.begin(), left_.end(), [&](uint32_t other) {
      const Point p = points_[other];
      return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  const std::vector<Point>& points_;
  std::vector<uint32_t> left_;
};

void append_polygon(TriangleMesh& result, std::span<const uint32_t> polygon, const std::string& where) {
  const auto emit = [&](size_t a, size_t b, size_t c) {
    result.triangles.push_back({polygon[a], polygon[b], polygon[c]});
  };
  if (polygon.size() == 3) return emit(0, 1, 2);
  const std::vector<Point> points = projected(result.vertices, polygon);
  if (is_convex(points)) {
    for (size_t i = 1; i + 1 < polygon.size(); ++i) emit(0, i, i + 1);
    return;
  }
  if (polygon.size() > kMaxConcaveCorners)
    throw Error(ErrorCode::kLimit, where,
                "a polygon that is not convex has " + std::to_string(polygon.size()) + " corners",
                "cut polygons down to " + std::to_string(kMaxConcaveCorners) + " corners");
  EarCutter(points).cut(emit);
}

struct Bits {
  std::array<uint32_t, 3> words;
  explicit Bits(const Vec3& v) { std::memcpy(words.data(), &v, sizeof words); }
  friend bool operator==(const Bits&, const Bits&) = default;
};
struct HashBits {
  size_t operator()(const Bits& bits) const {
    uint64_t hash = 0;
    for (const uint32_t word : bits.words) hash = (hash ^ word) * 0x9e3779b97f4a7c15u + (hash >> 29);
    return static_cast<size_t>(hash ^ (hash >> 32));
  }
};

}  // namespace

TriangleMesh triangulated(PolygonMesh mesh, const std::string& where) {
  TriangleMesh result;
  result.vertices = std::move(mesh.vertices);
  result.triangles.reserve(mesh.sizes.size());
  size_t begin = 0;
  for (const uint32_t size : mesh.sizes) {
    append_polygon(result, {mesh.corners.data() + begin, size}, where);
    begin += size;
  }
  return result;
}

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.triangles = mesh.triangles;
  std::unordered_map<Bits, uint32_t, HashBits> places;
  for (auto& triangle : result.triangles)
    for (uint32_t& index : triangle) {
      const Vec3 vertex = mesh.vertices[index];
      const auto [place, is_new] = places.try_emplace(Bits(vertex), static_cast<uint32_t>(result.vertices.size()));
      if (is_new) result.vertices.push_back(vertex);
      index = place->second;
    }
  return result;
}

}  // namespace raygrain
