#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "families/aim.h"
#include "families/shapes.h"

namespace raygrain {

using shapes::clamped_to_float;

namespace {

/// The edges of a mesh with the triangles beside them.
class Edges {
 public:
  explicit Edges(const TriangleMesh& mesh) : mesh_(mesh) {
    std::map<std::pair<uint32_t, uint32_t>, size_t> index_of;
    for (size_t t = 0; t < mesh.triangle_count(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const auto [p, q] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
        const auto [found, is_new] = index_of.try_emplace({p, q}, edges_.size());
        if (is_new) edges_.push_back({p, q, t, t});
        edges_[found->second].other = t;
      }
  }

  /// Two ends of an edge at which the mesh turns away from the eye, if a few tries find one.
  std::optional<std::array<Vec3d, 2>> silhouette(Vec3d eye, Random& random) const {
    for (int i = 0; i < 16 && !edges_.empty(); ++i) {
      const Edge& edge = edges_[random.below(edges_.size())];
      if (edge.one == edge.other || is_facing(edge.one, eye) != is_facing(edge.other, eye))
        return {{to_double(mesh_.vertices[edge.p]), to_double(mesh_.vertices[edge.q])}};
    }
    return {};
  }

 private:
  struct Edge {
    uint32_t p, q;
    size_t one, other;
  };

  bool is_facing(size_t t, Vec3d eye) const {
    const Vec3d a = to_double(mesh_.vertex(t, 0));
    return dot(cross(to_double(mesh_.vertex(t, 1)) - a, to_double(mesh_.vertex(t, 2)) - a), eye - a) > 0;
  }

  const TriangleMesh& mesh_;
  std::vector<Edge> edges_;
};

float stepped(float x, int steps) {
  for (; steps > 0; --steps) x = std::nextafter(x, kInf);
  for (; steps < 0; ++steps) x = std::nextafter(x, -kInf);
  return std::isfinite(x) ? x : 0;
}

/// Past an edge that is a silhouette from the ray's start, exactly, or by a hair.
Ray past_silhouette(Aim& aim, const Edges& edges) {
  const Vec3 origin = clamped_to_float(aim.place());
  const auto edge = edges.silhouette(to_double(origin), aim.random);
  if (!edge) return aim.towards(aim.edge_point());
  const auto [p, q] = *edge;
  Vec3d target = p + (q - p) * (aim.random.below(2) ? 0.5 : aim.random.uniform());
  if (aim.random.below(2)) target = target + aim.direction() * (aim.size() * 1e-7);
  return {origin, clamped_to_float(target - to_double(origin))};
}

/// From up to 10^9 times the mesh's size away; half of them along an axis, so that they still meet what they aim at.
Ray from_far(Aim& aim) {
  const Vec3d target = aim.target();
  const double away = std::max(aim.size(), 1e-30) * std::pow(10.0, aim.random.uniform(1, 9));
  Vec3d direction = aim.direction();
  if (aim.random.below(2)) {
    direction = {};
    direction[static_cast<int>(aim.random.below(3))] = aim.random.below(2) ? 1 : -1;
  }
  const Vec3 origin = clamped_to_float(target - direction * away);
  const bool is_exact = aim.random.below(2) != 0;
  return {origin, clamped_to_float(is_exact ? direction : target - to_double(origin))};
}

/// Sizes of direction that make t overflow, underflow, or a denormal.
Ray of_any_size(Aim& aim) {
  Ray ray = aim.towards(aim.target());
  const Vec3d d = to_double(ray.direction);
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (largest == 0) return ray;
  const int exponent = static_cast<int>(aim.random.below(270)) - 145;
  ray.direction = clamped_to_float(d * std::ldexp(1.0, exponent - std::ilogb(largest)));
  return ray;
}

/// Along an edge, from before it to behind it.
Ray along_edge(Aim& aim) {
  const auto [a, b, c] = aim.triangle();
  const double before = aim.random.below(2) ? 1 : aim.random.uniform(-1, 2);
  return {clamped_to_float(a - (b - a) * before), clamped_to_float(b - a)};
}

/// Towards a vertex or an edge, one or two floats beside it.
Ray beside(Aim& aim) {
  Ray ray = aim.towards(aim.random.below(2) ? aim.vertex() : aim.edge_point());
  const int axis = static_cast<int>(aim.random.below(3));
  const int steps = static_cast<int>(aim.random.below(5)) - 2;
  Vec3& moved = aim.random.below(2) ? ray.origin : ray.direction;
  moved[axis] = stepped(moved[axis], steps);
  return ray;
}

/// Away from a hair above or below the surface, often only a hair long: what shadow and bounce rays do.
Ray from_a_hair_above(Aim& aim) {
  const double height = aim.size() * std::ldexp(1.0, -8 - static_cast<int>(aim.random.below(24)));
  const Vec3d offset = aim.direction() * height;
  const Vec3d start = aim.target() + offset;
  const Vec3 origin = clamped_to_float(start);
  Ray ray{origin, clamped_to_float(aim.random.below(2) ? aim.target() - to_double(origin) : aim.direction())};
  const double ends[] = {1, 1e-3, 1e-6, 1 - 1e-6};
  if (aim.random.below(2)) ray.tmax = static_cast<float>(ends[aim.random.below(4)]);
  if (aim.random.below(4) == 0) ray.tmin = static_cast<float>(1e-6);
  return ray;
}

/// Origin and direction with few bits and many equal components: many planes and edges are met exactly.
Ray round_numbers(Aim& aim) {
  Ray ray{clamped_to_float(aim.random.below(2) ? aim.vertex() : aim.place()), {}};
  for (int k = 0; k < 3; ++k) ray.direction[k] = static_cast<float>(static_cast<int>(aim.random.below(5)) - 2);
  if (aim.random.below(2)) ray.tmin = -kInf;
  return ray;
}

/// Along an axis through a vertex or edge, but for a component that is smaller than the others by up to 2^90: exponents
/// that no fixed-size integer holds together.
Ray nearly_along_axis(Aim& aim) {
  const Vec3d target = aim.random.below(2) ? aim.vertex() : aim.edge_point(), place = aim.place();
  const int axis = static_cast<int>(aim.random.below(3));
  Vec3d origin = target;
  origin[axis] = place[axis];
  if (aim.random.below(3) == 0) origin[(axis + 1) % 3] = place[(axis + 1) % 3];
  Ray ray{clamped_to_float(origin), clamped_to_float(target - origin)};
  const double size = std::abs(static_cast<double>(ray.direction[axis]));
  const double share = aim.signed_uniform();
  const double small = share * std::ldexp(size, -static_cast<int>(aim.random.below(90)));
  ray.direction[(axis + 2) % 3] = clamped_to_float({small, 0, 0}).x;
  return ray;
}

Ray extreme_ray(Aim& aim, const Edges& edges, size_t kind) {
  switch (kind) {
    case 0:
    case 1:
      return past_silhouette(aim, edges);
    case 2:
      return from_far(aim);
    case 3:
      return of_any_size(aim);
    case 4:
      return along_edge(aim);
    case 5:
      return beside(aim);
    case 6:
      return from_a_hair_above(aim);
    case 7:
      return nearly_along_axis(aim);
    default:
      return round_numbers(aim);
  }
}

}  // namespace

std::vector<Ray> extreme_rays(const TriangleMesh& mesh, size_t count, uint64_t seed) {
  Aim aim(mesh, seed);
  const Edges edges(mesh);
  std::vector<Ray> rays;
  rays.reserve(count);
  while (rays.size() < count) rays.push_back(extreme_ray(aim, edges, rays.size() % 9));
  return rays;
}

std::vector<Ray> window_rays(std::span<const Ray> rays, std::span<const Hit> hits, uint64_t seed) {
  Random random(seed);
  std::vector<Ray> result(rays.begin(), rays.end());
  for (size_t i = 0; i < result.size(); ++i) {
    const float t = is_hit(hits[i]) ? hits[i].t : static_cast<float>(random.uniform(0, 2));
    const float ends[] = {t, std::nextafter(t, -kInf), std::nextafter(t, kInf)};
    const uint64_t kind = random.below(4);
    if (kind != 1) result[i].tmax = ends[random.below(3)];
    if (kind == 1 || kind == 2) result[i].tmin = ends[random.below(3)];
    if (kind == 3) result[i].tmin = -kInf;
  }
  return result;
}

std::vector<Vec3> points_near(const TriangleMesh& mesh, Vec3 direction, size_t count, uint64_t seed) {
  Aim aim(mesh, seed);
  const Vec3d d = to_double(direction);
  const double long_side = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  const double step = long_side > 0 ? aim.size() / long_side : 0;
  std::vector<Vec3> points;
  points.reserve(count);
  while (points.size() < count) {
    Vec3d p = aim.random.below(5) == 0 ? aim.place() : aim.target();
    const double shifts[] = {0, 1e-6, -1e-6, 1e-4, -1e-4, 0.1, -0.1, 1, -1, 2, -2, 30, -30};
    if (step > 0)
      p = p + d * (step * shifts[aim.random.below(std::size(shifts))]);
    else if (aim.random.below(2)) {
      const double distance = aim.size() * std::ldexp(1.0, -static_cast<int>(aim.random.below(30)));
      p = p + aim.direction() * distance;
    }
    points.push_back(clamped_to_float(p));
  }
  return points;
}

}  // namespace raygrain
